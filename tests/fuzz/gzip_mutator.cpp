/// Mutates what is in a gzip stream rather than the stream, whose checksums would fail; the stream itself
/// sometimes. Linked with targets of libFuzzer only.
#include <cstdint>
#include <cstring>
#include <string>

#include "pipeline/rib/syntax/source_text.h"
#include "pipeline/rib/write/gzip_writer.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
    using namespace trapeze::rib;
    constexpr unsigned kStreamsThemselves = 8;  // one of so many
    constexpr size_t kMostBytes = size_t{1} << 16;
    const bool is_gzip = size > 2 && data[0] == 0x1f && data[1] == 0x8b;
    if (!is_gzip || seed % kStreamsThemselves == 0) return LLVMFuzzerMutate(data, size, max_size);
    std::string problem;
    std::string text =
        inflated({reinterpret_cast<const char*>(data), size}, Packing::Gzip, kMostBytes, &problem);
    const size_t length = text.size();
    text.resize(kMostBytes);
    text.resize(LLVMFuzzerMutate(reinterpret_cast<uint8_t*>(text.data()), length, text.size()));
    std::string packed;
    GzipWriter writer([&](std::string_view bytes) { packed += bytes; });
    writer.add(text);
    writer.finish();
    if (packed.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
    std::memcpy(data, packed.data(), packed.size());
    return packed.size();
}
