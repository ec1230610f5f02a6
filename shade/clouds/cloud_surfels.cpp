#include "shade/clouds/cloud_surfels.h"

#include <numbers>
#include <optional>

namespace trapeze {
namespace {

/// The first of a channel's floats among a point's.
std::optional<size_t> first_of(const PointCloud& cloud, std::string_view name, bool color) {
    size_t first = 0;
    for (const CloudChannel& channel : cloud.channels) {
        const bool fits =
            (channel.type == ChannelType::Color) == color && (color || floats_of(channel.type) == 1);
        if (channel.name == name && fits) return first;
        first += static_cast<size_t>(floats_of(channel.type));
    }
    return {};
}

}  // namespace

Surfels surfels_of(const PointCloud& cloud) {
    const size_t stride = cloud.floats_per_point();
    const std::optional<size_t> area = first_of(cloud, "_area", false);
    const std::optional<size_t> radiosity = first_of(cloud, "_radiosity", true);
    Surfels surfels;
    for (size_t i = 0; i < cloud.size(); ++i) {
        const float* const values = cloud.values.data() + i * stride;
        const float own = area ? values[*area] : cloud.radii[i] * cloud.radii[i] * std::numbers::pi_v<float>;
        if (!(own > 0)) continue;
        surfels.positions.push_back(cloud.positions[i]);
        surfels.normals.push_back(cloud.normals[i]);
        surfels.areas.push_back(own);
        if (!radiosity) continue;
        surfels.radiosities.emplace_back(values[*radiosity], values[*radiosity + 1], values[*radiosity + 2]);
    }
    return surfels;
}

}  // namespace trapeze
