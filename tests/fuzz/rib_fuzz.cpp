/// The RIB reader on bytes from strangers: text, binary, gzip, and the member "a" of a zip archive. With
/// clang: -fsanitize=fuzzer,address,undefined and tests/fuzz/seeds/rib as corpus. With any compiler: linked
/// with replay_main.cpp it runs the seeds and mutations of them.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/rib/programs/end_of_answer.h"
#include "pipeline/rib/read_rib.h"

/// A program's answer ends at the same place however it arrives.
static void find_end_of_answer(std::string_view bytes) {
    trapeze::rib::EndOfAnswer in_parts, whole;
    std::optional<size_t> place;
    for (size_t length = 0; length < bytes.size() && !place; length += 1 + length / 8)
        place = in_parts.find(bytes.substr(0, length));
    if (!place) place = in_parts.find(bytes);
    if (place != whole.find(bytes)) __builtin_trap();
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    find_end_of_answer({reinterpret_cast<const char*>(data), size});
    const int file = memfd_create("rib", 0);
    if (file < 0 || write(file, data, size) != static_cast<ssize_t>(size)) return 0;
    const bool is_zip = size >= 2 && data[0] == 'P' && data[1] == 'K';
    const std::vector<std::string> files{"/proc/self/fd/" + std::to_string(file) + (is_zip ? "!a" : "")};
    trapeze::Diagnostics diagnostics;
    trapeze::ReadOptions options;
    // Bombs end here.
    options.max_source_bytes = size_t{1} << 20;
    options.most_archives_read = 1000;
    options.most_bytes_read = uint64_t{1} << 22;
    options.most_instanced_primitives = 10000;
    trapeze::read_rib(files, options, diagnostics, [](trapeze::Scene&&) {});
    close(file);
    return 0;
}
