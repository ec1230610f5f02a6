/// What the samples of a tile see: for each, its hits from front to back, ending with the first opaque one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.h"

namespace trapeze {

/// Where a ray meets a micropolygon.
struct Hit {
    float depth = 0;                      ///< along the ray's axis; camera-space z for camera rays
    uint64_t id = MicropolygonId::kNone;  ///< MicropolygonId::packed()

    bool operator==(const Hit&) const = default;
};

/// The order of hits along a sample: nearer first, equal depths by smaller id.
constexpr bool in_front(const Hit& a, const Hit& b) {
    return a.depth < b.depth || (a.depth == b.depth && a.id < b.id);
}

/// The hits of a tile's samples, one after another.
struct HitBuffer {
    std::vector<uint32_t> first;  ///< sample s has hits[first[s]] .. hits[first[s + 1]]; size() + 1 entries
    std::vector<Hit> hits;

    size_t size() const { return first.empty() ? 0 : first.size() - 1; }
    std::span<const Hit> of(size_t sample) const {
        return {hits.data() + first[sample], hits.data() + first[sample + 1]};
    }
    bool operator==(const HitBuffer&) const = default;
};

}  // namespace trapeze
