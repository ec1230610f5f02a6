#include "pipeline/cli/support/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace trapeze {
namespace {

int g_reason = 0;  ///< errno of the first text that could not be printed; there is one standard output

}  // namespace

void prepare_standard_streams() {
    // For reading: what is written there fails, as it would.
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(stream, F_GETFD) == -1 && errno == EBADF) static_cast<void>(open("/dev/null", O_RDONLY));
    // A handler, which does not outlive exec(), rather than SIG_IGN, which does. SIGXFSZ: a file has become
    // as large as the user's limit allows.
    for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, [](int) {});
}

void print_text(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() && g_reason == 0) g_reason = errno;
}

bool printed_all(Terminal& terminal) {
    const bool flushed = std::fflush(stdout) == 0;
    const int reason = g_reason ? g_reason : flushed ? 0 : errno;
    if (flushed && !std::ferror(stdout)) return true;
    terminal.show({Severity::Error,
                   std::string("cannot write to standard output") +
                       (reason ? std::string(": ") + std::strerror(reason) : std::string()),
                   {},
                   {},
                   {}});
    std::clearerr(stdout);
    return false;
}

}  // namespace trapeze
