/// The channels of an OpenEXR file: what each is called, and where the picture has its values.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "composite/displays/picture_to_write.h"

namespace trapeze {

/// One number a pixel of the picture's window.
struct ExrChannel {
    enum class Type : uint8_t { Half, Float, Uint };

    std::string name;
    Type type = Type::Half;         ///< in the file; values of Half and Float are floats in memory
    const float* floats = nullptr;  ///< of the window's first pixel
    const uint32_t* ids = nullptr;  ///< instead of floats: Type::Uint
    size_t stride = 1;              ///< values from a pixel to the next
};

/// The channels of all displays of the file, in their order.
std::vector<ExrChannel> exr_channels(const PictureToWrite& picture);

}  // namespace trapeze
