#include <zlib.h>

#include "shade/maps/headers/formats.h"

namespace trapeze {
namespace {

/// Chunks before the pixels that are longer are left to OpenImageIO.
constexpr uint32_t kMostChunkBytes = 1 << 24;

struct Chunk {
    std::string name, data;
};

/// The next chunk; nothing where it is cut off or its sum is wrong.
std::optional<Chunk> next_chunk(HeaderBytes& bytes) {
    const uint32_t length = bytes.u32();
    if (length > kMostChunkBytes) return {};
    Chunk chunk;
    const std::string summed = bytes.text(4 + size_t{length});
    const uint32_t sum = bytes.u32();
    if (!bytes.is_good()) return {};
    if (crc32(0, reinterpret_cast<const Bytef*>(summed.data()), static_cast<uInt>(summed.size())) != sum)
        return {};
    chunk.name = summed.substr(0, 4), chunk.data = summed.substr(4);
    return chunk;
}

uint32_t byte(const std::string& data, size_t at) {
    return static_cast<unsigned char>(data[at]);
}

uint32_t big_endian(const std::string& data, size_t at) {
    return byte(data, at) << 24 | byte(data, at + 1) << 16 | byte(data, at + 2) << 8 | byte(data, at + 3);
}

constexpr uint32_t kGrey = 0, kColor = 2, kPalette = 3, kGreyAlpha = 4, kColorAlpha = 6;

bool is_plain_header(const Chunk& chunk) {
    const std::string& data = chunk.data;
    if (chunk.name != "IHDR" || data.size() != 13) return false;
    const uint32_t bits = byte(data, 8), kind = byte(data, 9);
    const bool has_few_bits = bits == 1 || bits == 2 || bits == 4;
    const bool fits = kind == kGrey      ? has_few_bits || bits == 8 || bits == 16
                      : kind == kPalette ? has_few_bits || bits == 8
                                         : (kind == kColor || kind == kGreyAlpha || kind == kColorAlpha) &&
                                               (bits == 8 || bits == 16);
    return fits && is_plain_size(big_endian(data, 0), big_endian(data, 4)) && byte(data, 10) == 0 &&
           byte(data, 11) == 0 && byte(data, 12) <= 1;
}

bool is_ancillary(const std::string& name) {
    return name[0] >= 'a' && name[0] <= 'z';
}

}  // namespace

std::optional<MapHeader> plain_png(HeaderBytes& bytes) {
    constexpr uint64_t kMark = 8;
    bytes.seek(kMark);
    const auto header = next_chunk(bytes);
    if (!header || !is_plain_header(*header)) return {};
    const bool needs_palette = byte(header->data, 9) == kPalette;
    bool has_palette = false;
    while (bytes.is_good()) {
        const uint64_t at = bytes.position();
        const uint32_t length = bytes.u32();
        if (bytes.text(4) == "IDAT")
            return needs_palette <= has_palette && bytes.has(bytes.position(), length)
                       ? std::optional(MapHeader())
                       : std::nullopt;
        bytes.seek(at);
        const auto chunk = next_chunk(bytes);
        if (!chunk) return {};
        if (chunk->name == "PLTE" && !has_palette && !chunk->data.empty() && chunk->data.size() % 3 == 0 &&
            chunk->data.size() <= 768)
            has_palette = true;
        else if (!is_ancillary(chunk->name))
            return {};
    }
    return {};
}

}  // namespace trapeze
