/// For tests: pictures for viewers, made of numbers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pipeline/preview/preview_board.h"

namespace trapeze::testing {

/// Channels of a window whose values say where they are, and which picture they are of.
struct NumberedPicture {
    PixelRect window;
    std::vector<std::vector<float>> values;

    NumberedPicture(const PixelRect& of, size_t channels, float offset = 0) : window(of) {
        for (size_t c = 0; c < channels; ++c) {
            values.emplace_back();
            for (int y = of.y0; y < of.y1; ++y)
                for (int x = of.x0; x < of.x1; ++x) values[c].push_back(value(c, x, y, offset));
        }
    }
    static float value(size_t channel, int x, int y, float offset = 0) {
        return static_cast<float>(channel) * 10000 + static_cast<float>(y) * 100 + static_cast<float>(x) +
               offset;
    }
    PixelSource source() const {
        PixelSource source{window, {}};
        for (const auto& plane : values) source.channels.push_back({plane.data(), 1});
        return source;
    }
};

inline std::shared_ptr<PreviewPicture> make_preview_picture(const PixelRect& window,
                                                            std::string name = "a.exr", int width = 64,
                                                            int height = 48) {
    return std::make_shared<PreviewPicture>(
        PreviewFacts{std::move(name), width, height, window, {"R", "G", "B", "A", "Z"}});
}

}  // namespace trapeze::testing
