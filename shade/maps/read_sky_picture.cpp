#include "shade/maps/read_sky_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/portable_math.h"

namespace trapeze {
namespace {

/// Directions of the cells' middles, and their differences from cell to cell: what a lookup is filtered over.
struct CellDirections {
    std::vector<float> planes[9];

    CellDirections(int width, int height) {
        constexpr double kPi = std::numbers::pi;
        for (int row = 0; row < height; ++row)
            for (int column = 0; column < width; ++column) {
                const double down = kPi * (row + 0.5) / height, turn = 2 * kPi * (column + 0.5) / width;
                const double z = portable::cos(down), across = portable::sin(down);
                const double c = portable::cos(turn), s = portable::sin(turn);
                const double du = 2 * kPi / width, dv = kPi / height;
                const double values[] = {c * across,       s * across,      z,
                                         -s * across * du, c * across * du, 0,
                                         c * z * dv,       s * z * dv,      -across * dv};
                for (size_t k = 0; k < 9; ++k) planes[k].push_back(static_cast<float>(values[k]));
            }
    }
    ConstPlane3 triple(size_t first) const { return {planes[first], planes[first + 1], planes[first + 2]}; }
};

/// Cells along one side of a picture of so many pixels.
int cells_of(int pixels, int most, int least) {
    if (pixels >= least) return std::min(pixels, most);
    return pixels * ((least + pixels - 1) / pixels);
}

}  // namespace

SkyPicture read_sky_picture(Textures& textures, std::string_view name, SourceLocation location,
                            int most_columns, int least_columns) {
    SkyPicture sky;
    const Textures::Picture* picture =
        textures.find(name, location, textures.reading_of_lookup("", true, location));
    const auto info = textures.info(name);
    if (!picture || !info || info->width < 1 || info->height < 1) return sky;
    sky.width = cells_of(info->width, most_columns, least_columns);
    sky.height = cells_of(info->height, most_columns / 2, least_columns / 2);
    MapOptions options;
    // Cells that are pixels, or parts of them, have the pixels' values.
    if (sky.width >= info->width && sky.height >= info->height) options.filter = MapOptions::Filter::Nearest;
    const CellDirections directions(sky.width, sky.height);
    const size_t count = directions.planes[0].size();
    std::vector<float> memory(3 * count);
    const auto plane_of = [&](size_t k) { return Plane(memory).subspan(k * count, count); };
    const Plane planes[] = {plane_of(0), plane_of(1), plane_of(2)};
    textures.environment(picture, {directions.triple(0), directions.triple(3), directions.triple(6)}, options,
                         {count, {}}, planes);
    const auto valid = [](float x) { return std::isfinite(x) && x > 0 ? x : 0.0f; };
    for (size_t i = 0; i < count; ++i)
        sky.colors.emplace_back(valid(planes[0][i]), valid(planes[1][i]), valid(planes[2][i]));
    return sky;
}

}  // namespace trapeze
