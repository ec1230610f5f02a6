#include "pipeline/rib/program_answer.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "pipeline/rib/answer_end.h"

namespace trapeze::rib {
namespace {

using Clock = std::chrono::steady_clock;

/// False at the end of its output.
bool read_some(int output, std::string& text) {
    constexpr size_t kBlock = 65536;
    const size_t old = text.size();
    text.resize(old + kBlock);
    const ssize_t got = read(output, text.data() + old, kBlock);
    text.resize(old + static_cast<size_t>(std::max<ssize_t>(got, 0)));
    return got > 0 || (got < 0 && errno == EINTR);
}

}  // namespace

ProgramAnswer ask_program(int input, int output, const std::string& request,
                          std::chrono::milliseconds time_limit, size_t most_bytes) {
    ProgramAnswer answer;
    AnswerEnd end;
    size_t sent = 0;
    for (const auto until = Clock::now() + time_limit;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now());
        pollfd waits[] = {{output, POLLIN, 0}, {sent < request.size() ? input : -1, POLLOUT, 0}};
        const int ready = left.count() > 0 ? poll(waits, 2, static_cast<int>(left.count())) : 0;
        if (ready == 0) {
            answer.problem = "does not answer";
            return answer;
        }
        if (ready < 0) continue;  // a signal
        if (waits[1].revents != 0) {
            const ssize_t count =
                send(input, request.data() + sent, request.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
            sent = count >= 0                          ? sent + static_cast<size_t>(count)
                   : errno == EAGAIN || errno == EINTR ? sent
                                                       : request.size();  // it reads no more
        }
        if (waits[0].revents == 0) continue;
        const bool goes_on = read_some(output, answer.text);
        if (const auto place = end.find(answer.text)) {
            answer.text.resize(*place);
            return answer;
        }
        if (!goes_on) answer.problem = "ended before its answer did (with a byte 0377)";
        if (answer.text.size() > most_bytes) answer.problem = "answers with too much";
        if (!answer.problem.empty()) return answer;
    }
}

}  // namespace trapeze::rib
