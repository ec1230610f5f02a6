/// What a program of a Procedural "RunProgram" may answer: any bytes, in any pieces, whole, cut off or late.
/// No program runs: the bytes wait in a pipe. Each answer is read as RIB in a block of its own, as
/// procedurals are. The first bytes say how the rest is cut into pieces. Built and replayed as rib_fuzz.cpp
/// is, with tests/fuzz/seeds/program_answer as corpus.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "pipeline/rib/programs/end_of_answer.h"
#include "pipeline/rib/programs/program_answer.h"
#include "pipeline/rib/read_rib.h"
#include "tests/fuzz/byte_source.h"

namespace {

using namespace trapeze;

/// A program's ends, seen from the reader.
struct Ends {
    int input[2], output[2];

    Ends() {
        // Each write to the pipe is read as one piece.
        if (socketpair(AF_UNIX, SOCK_STREAM, 0, input) != 0 || pipe2(output, O_DIRECT) != 0) std::abort();
        fcntl(output[1], F_SETFL, O_DIRECT | O_NONBLOCK);
    }
    ~Ends() {
        close(input[0]), close(input[1]), close(output[0]);
        hang_up();
    }
    void hang_up() {
        if (output[1] >= 0) close(output[1]);
        output[1] = -1;
    }
};

/// Puts the bytes into the pipe; what has place in it.
std::string write_in_pieces(int output, std::string_view bytes, const uint8_t (&lengths)[4]) {
    constexpr int kMostPieces = 16;  // an ordinary pipe's
    size_t at = 0;
    for (int i = 0; i < kMostPieces && at < bytes.size(); ++i) {
        constexpr size_t kLargestPiece = 4096;
        const size_t wanted = i + 1 < kMostPieces ? size_t{lengths[i % 4]} + 1 : kLargestPiece;
        const std::string_view piece = bytes.substr(at, std::min(wanted, kLargestPiece));
        if (write(output, piece.data(), piece.size()) != static_cast<ssize_t>(piece.size())) break;
        at += piece.size();
    }
    return std::string(bytes.substr(0, at));
}

/// As Procedural does, from a file.
void read_answer(const std::string& answer) {
    const int file = memfd_create("answer", 0);
    if (file < 0 || write(file, answer.data(), answer.size()) != static_cast<ssize_t>(answer.size()))
        std::abort();
    Diagnostics diagnostics([](const Diagnostic&) {});
    ReadOptions options;
    options.max_source_bytes = options.most_bytes_read = size_t{1} << 20;
    options.most_archives_read = 100;
    options.most_instanced_primitives = 10000;
    const std::string text =
        "Display \"a\" \"file\" \"rgb\" WorldBegin Attribute \"user\" \"float a\" [1] "
        "Procedural \"DelayedReadArchive\" [\"/proc/self/fd/" +
        std::to_string(file) +
        "\"] [0 1 0 1 0 1] "
        "Sphere 1 -1 1 360 WorldEnd";
    read_rib_text(text, "fuzz", options, diagnostics, [](Scene&&) {});
    close(file);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    fuzz::ByteSource bytes(data, size);
    uint8_t lengths[4];
    for (uint8_t& length : lengths) length = bytes.byte();
    const bool late = bytes.once_in(64), small_limit = bytes.once_in(16);
    Ends ends;
    const auto rest = bytes.rest();
    const std::string arriving =
        write_in_pieces(ends.output[1], {reinterpret_cast<const char*>(rest.data()), rest.size()}, lengths);
    if (!late) ends.hang_up();
    const size_t most_bytes = small_limit ? 100 : size_t{1} << 20;
    // In time unless the program is late: then nobody waits for it.
    const std::chrono::milliseconds time_limit(late ? 2 : 20000);
    const rib::ProgramAnswer answer =
        rib::ask_program(ends.input[0], ends.output[0], "1 data\n", {time_limit, most_bytes, {}, nullptr});
    const auto end = rib::EndOfAnswer().find(arriving);
    if (!small_limit && !late) {
        if (answer.problem.empty() != end.has_value()) std::abort();
        if (answer.text != arriving.substr(0, end.value_or(arriving.size()))) std::abort();
    }
    read_answer(answer.text);
    return 0;
}
