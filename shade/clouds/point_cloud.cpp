#include "shade/clouds/point_cloud.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trapeze {
namespace {

constexpr std::pair<std::string_view, ChannelType> kTypes[] = {
    {"float", ChannelType::Float},   {"color", ChannelType::Color},   {"point", ChannelType::Point},
    {"vector", ChannelType::Vector}, {"normal", ChannelType::Normal}, {"matrix", ChannelType::Matrix}};

constexpr size_t kMostLetters = 64;

}  // namespace

std::string_view name_of(ChannelType type) {
    for (const auto& [word, known] : kTypes)
        if (known == type) return word;
    return {};
}

bool channel_type_named(std::string_view word, ChannelType* type) {
    for (const auto& [known, known_type] : kTypes)
        if (known == word) {
            *type = known_type;
            return true;
        }
    return false;
}

bool is_channel_name(std::string_view name) {
    return !name.empty() && name.size() <= kMostLetters &&
           std::ranges::all_of(name, [](char c) { return c > ' ' && c < '\x7f' && c != ',' && c != '"'; });
}

size_t PointCloud::floats_per_point() const {
    size_t floats = 0;
    for (const CloudChannel& channel : channels) floats += static_cast<size_t>(floats_of(channel.type));
    return floats;
}

Box3f PointCloud::bounds() const {
    Box3f box;
    for (const V3f& p : positions)
        if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) box.extendBy(p);
    return box;
}

}  // namespace trapeze
