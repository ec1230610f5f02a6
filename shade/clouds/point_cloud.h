/// Points with a normal, a radius and named values: what bake3d() writes and texture3d() reads.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"

namespace trapeze {

enum class ChannelType { Float, Color, Point, Vector, Normal, Matrix };

/// A channel's floats at each point.
constexpr int floats_of(ChannelType type) {
    return type == ChannelType::Float ? 1 : type == ChannelType::Matrix ? 16 : 3;
}

struct CloudChannel {
    std::string name;
    ChannelType type = ChannelType::Float;

    bool operator==(const CloudChannel&) const = default;
};

/// "float", "color" and so on, as the files have them.
std::string_view name_of(ChannelType type);
/// False, with *type as it was, for another word.
bool channel_type_named(std::string_view word, ChannelType* type);

/// Whether files can hold a channel of this name: a word of at most 64 letters, digits and marks.
bool is_channel_name(std::string_view name);

/// Structure of arrays. Positions and values are in the space that they were baked in; normals have unit
/// length, or none where the point faces all sides.
struct PointCloud {
    std::vector<CloudChannel> channels;
    std::vector<V3f> positions, normals;
    std::vector<float> radii;   ///< of discs as large as the surface that a point stands for
    std::vector<float> values;  ///< floats_per_point() for each point, in the order of the channels

    size_t size() const { return positions.size(); }
    size_t floats_per_point() const;
    /// Of the positions that are finite; empty where there are none.
    Box3f bounds() const;
};

/// Files with more are not read: bounds on absurd input.
inline constexpr size_t kMostChannels = 256;

}  // namespace trapeze
