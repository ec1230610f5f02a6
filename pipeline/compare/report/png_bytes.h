/// A picture as the bytes of a PNG file, for documents that carry their pictures.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace trapeze {

/// Encodes width * height pixels of red, green and blue, row by row, which are encoded by the sRGB curve
/// already. Throws std::runtime_error when OpenImageIO cannot.
std::vector<unsigned char> png_bytes(int width, int height, std::span<const uint8_t> rgb);

}  // namespace trapeze
