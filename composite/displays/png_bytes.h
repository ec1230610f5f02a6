/// A picture as the bytes of a PNG file, for documents that carry their pictures.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace trapeze {

/// Of width * height pixels of red, green and blue, row by row, already encoded by the sRGB curve. Throws
/// std::runtime_error when OpenImageIO cannot.
std::vector<unsigned char> png_bytes(int width, int height, std::span<const uint8_t> rgb);

}  // namespace trapeze
