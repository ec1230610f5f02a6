/// The formats of plain_map_header(), which has read and found their first bytes.
#pragma once

#include <optional>

#include "shade/maps/headers/header_bytes.h"
#include "shade/maps/headers/map_header.h"

namespace trapeze {

/// Pictures of more pixels a side, or in all, are left to OpenImageIO, which has limits of its own.
inline constexpr uint64_t kMostPlainSide = 65535, kMostPlainPixels = 1 << 26;

inline bool is_plain_size(uint64_t width, uint64_t height) {
    return width > 0 && height > 0 && width <= kMostPlainSide && height <= kMostPlainSide &&
           width * height <= kMostPlainPixels;
}

/// Portable Network Graphics, 2nd edition (ISO/IEC 15948:2003).
std::optional<MapHeader> plain_png(HeaderBytes& bytes);
/// Baseline JPEG with its own tables (ITU-T T.81, annex B).
std::optional<MapHeader> plain_jpeg(HeaderBytes& bytes);
/// TIFF 6.0, with chunky pixels of 8 to 32 bits a channel.
std::optional<MapHeader> plain_tiff(HeaderBytes& bytes);
/// OpenEXR of one part that is not deep, by OpenEXR itself.
std::optional<MapHeader> plain_exr(const std::string& path);

}  // namespace trapeze
