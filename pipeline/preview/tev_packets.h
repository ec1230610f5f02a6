/// What tev, the viewer of pictures, is told: packets of its protocol (tev, "include/tev/Ipc.h"). Numbers are
/// little-endian; a packet begins with the count of its bytes, these four included, and a byte that says its
/// kind.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/pixel_rect.h"

namespace trapeze {

/// Makes an image of this name, in place of one that there is, with nothing in its channels.
std::string tev_create_image(std::string_view name, int width, int height,
                             std::span<const std::string> channels);

/// Puts pixels into an image: `values` has channel after channel, each row by row.
std::string tev_update_image(std::string_view name, std::span<const std::string> channels,
                             const PixelRect& pixels, std::span<const float> values);

}  // namespace trapeze
