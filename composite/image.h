/// A finished picture: what displays are written from.
#pragma once

#include <cstdint>
#include <vector>

#include "composite/deep_sample.h"
#include "core/scene/camera.h"

namespace trapeze {

/// Image::id of a pixel that shows nothing.
inline constexpr uint32_t kNoPrimitive = ~uint32_t{0};

/// Float planes of a frame. Equal pictures are equal in every bit.
struct Image {
    int width = 0, height = 0;  ///< of the whole picture
    PixelRect window;           ///< the pixels that are here: the crop
    std::vector<float>
        rgba;  ///< 4 a pixel, row by row; colour premultiplied, exposed, linear unless gamma was asked for
    std::vector<float> z;  ///< camera-space depth; kInfinity where nothing is
    std::vector<uint32_t>
        id;  ///< index in Scene::primitives of what the sample nearest the centre sees; may be empty

    std::vector<float> aovs;  ///< aov_channels a pixel, row by row: what Displays ask for besides, by
                              ///< aov_layout(); not exposed
    int aov_channels = 0;

    /// Ids and coverages of Cryptomatte's layers, matte_floats a pixel, row by row: of each of
    /// matte_layers() the ranks as rank_mattes() writes them.
    std::vector<float> mattes;
    int matte_floats = 0;
    float matte_loss = 0;  ///< the greatest coverage of a pixel that a layer has left out
    /// Samples of a deep picture by pixel, row by row; colours after Exposure's gain. May be empty.
    std::vector<std::vector<DeepSample>> deep;

    /// Place of a pixel of the window in z and id; times 4 in rgba, times aov_channels in aovs.
    size_t index(int x, int y) const {
        return static_cast<size_t>(y - window.y0) * window.width() + static_cast<size_t>(x - window.x0);
    }
    bool operator==(const Image&) const = default;
};

}  // namespace trapeze
