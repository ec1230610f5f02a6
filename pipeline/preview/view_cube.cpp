#include "pipeline/preview/view_cube.h"

#include <array>
#include <cmath>

namespace trapeze {

ViewCube bake_view(const ColorTransform& view) {
    constexpr int side = ViewCube::kSide;
    std::array<float, side> values{};
    for (int i = 0; i < side; ++i)
        values[static_cast<size_t>(i)] =
            ViewCube::kToe *
            (std::exp2(std::log2(ViewCube::kMost / ViewCube::kToe + 1) * static_cast<float>(i) / (side - 1)) -
             1);
    std::vector<float> colors;
    colors.reserve(size_t{4} * side * side * side);
    for (const float blue : values)
        for (const float green : values)
            for (const float red : values) colors.insert(colors.end(), {red, green, blue, 1});
    view.apply(colors.data(), colors.size() / 4);
    ViewCube cube;
    cube.rgb.reserve(colors.size() / 4 * 3);
    for (size_t i = 0; i < colors.size(); i += 4)
        cube.rgb.insert(cube.rgb.end(), {colors[i], colors[i + 1], colors[i + 2]});
    return cube;
}

}  // namespace trapeze
