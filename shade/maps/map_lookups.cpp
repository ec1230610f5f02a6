#include "shade/maps/map_lookups.h"

#include "shade/maps/map_lanes.h"

namespace trapeze {

MapOptions::Filter map_filter(std::string_view name) {
    if (name == "box" || name == "triangle" || name == "bilinear") return MapOptions::Filter::Bilinear;
    if (name == "nearest" || name == "closest" || name == "point") return MapOptions::Filter::Nearest;
    return MapOptions::Filter::Smooth;
}

MapOptions::Wrap map_wrap(std::string_view name) {
    if (name == "black") return MapOptions::Wrap::Black;
    if (name == "periodic") return MapOptions::Wrap::Periodic;
    if (name == "clamp") return MapOptions::Wrap::Clamp;
    if (name == "mirror") return MapOptions::Wrap::Mirror;
    return MapOptions::Wrap::OfPicture;
}

void quad_sides(ConstPlane corner_00, ConstPlane corner_10, ConstPlane corner_01, ConstPlane corner_11,
                const QuadSides& sides) {
    for (size_t i = 0; i < sides.middle.size(); ++i) {
        const float a = map_lanes::value(corner_00, i), b = map_lanes::value(corner_10, i);
        const float c = map_lanes::value(corner_01, i), d = map_lanes::value(corner_11, i);
        sides.middle[i] = ((a + b) + (c + d)) * 0.25f;
        sides.along_u[i] = ((b - a) + (d - c)) * 0.5f;
        sides.along_v[i] = ((c - a) + (d - b)) * 0.5f;
    }
}

}  // namespace trapeze
