/// Point clouds for tests.
#pragma once

#include <cstdint>
#include <string>

#include "shade/clouds/ply_file.h"
#include "shade/clouds/ptc_file.h"

namespace trapeze::testing {

/// Numbers that look random, the same on every machine.
class Numbers {
  public:
    explicit Numbers(uint32_t seed) : state_(seed) {}
    uint32_t bits() { return state_ = state_ * 1664525u + 1013904223u; }
    /// 0 .. 1.
    float next() { return static_cast<float>(bits() >> 8) * 0x1p-24f; }
    float between(float low, float high) { return low + (high - low) * next(); }
    V3f in_cube() {
        const float x = between(-1, 1), y = between(-1, 1);
        return {x, y, between(-1, 1)};
    }

  private:
    uint32_t state_;
};

/// Points with one channel of each type that PLY has, too.
inline PointCloud some_cloud(size_t points, uint32_t seed = 1) {
    Numbers numbers(seed);
    PointCloud cloud;
    cloud.channels = {{"_area", ChannelType::Float},
                      {"_radiosity", ChannelType::Color},
                      {"_where", ChannelType::Point},
                      {"_flow", ChannelType::Vector},
                      {"_bent", ChannelType::Normal}};
    for (size_t i = 0; i < points; ++i) {
        cloud.positions.push_back(numbers.in_cube() * 7.0f);
        const V3f normal = numbers.in_cube();
        cloud.normals.push_back(i % 5 == 4 ? V3f(0) : normal.normalized());
        cloud.radii.push_back(numbers.between(.001f, .4f));
        for (size_t k = 0; k < cloud.floats_per_point(); ++k) cloud.values.push_back(numbers.between(-9, 9));
    }
    return cloud;
}

inline std::string ptc_of(const PointCloud& cloud) {
    std::string bytes;
    write_ptc(cloud, {}, [&](std::string_view more) {
        bytes += more;
        return true;
    });
    return bytes;
}

inline std::string ply_of(const PointCloud& cloud, bool ascii) {
    std::string bytes;
    write_ply(cloud, ascii, [&](std::string_view more) {
        bytes += more;
        return true;
    });
    return bytes;
}

}  // namespace trapeze::testing
