/// Heights over a shadow map, for surfaces that keep away from what it saw (a Blobby's repelling planes).
#include <algorithm>
#include <array>
#include <cmath>

#include "shade/maps/map_space.h"
#include "shade/maps/textures_impl.h"

namespace trapeze {
namespace {

constexpr int64_t kMostPixels = int64_t{1} << 26;  ///< of a map that is kept whole: 256 MB

/// Heights over a map that is whole in memory: a polygoniser looks up millions of points all over it.
class Heights {
  public:
    Heights(const DepthView& map, const M44f& camera_from_world,
            std::shared_ptr<const std::vector<float>> depths)
        : space_(map, camera_from_world),
          x0_(map.x0),
          y0_(map.y0),
          width_(map.x1 - map.x0),
          height_(map.y1 - map.y0),
          perspective_(map.perspective),
          depths_(std::move(depths)) {}

    /// Height of a current-space point over what the map saw, along the map's depth: positive on the side of
    /// the map's camera. Infinite where the map has nothing. Bilinear between the middles of four pixels in
    /// what is linear over planes; pixels that saw nothing are left out.
    float at(const V3f& p) const {
        const MapPoint here = space_(p);
        if (!here.seen) return kInfinity;
        // Pixels from the middle of the first one.
        const float x = here.x - static_cast<float>(x0_) - 0.5f, y = here.y - static_cast<float>(y0_) - 0.5f;
        if (!(x >= -0.5f && x <= static_cast<float>(width_) - 0.5f)) return kInfinity;
        if (!(y >= -0.5f && y <= static_cast<float>(height_) - 0.5f)) return kInfinity;
        const float column = std::floor(x), row = std::floor(y), part_x = x - column, part_y = y - row;
        float sum = 0, weights = 0;
        for (int k = 0; k < 4; ++k) {
            const int i = std::clamp(static_cast<int>(column) + (k & 1), 0, width_ - 1);
            const int j = std::clamp(static_cast<int>(row) + (k >> 1), 0, height_ - 1);
            const float depth = (*depths_)[static_cast<size_t>(j) * static_cast<size_t>(width_) + i];
            if (!(depth > 0 && depth < kInfinity)) continue;
            const float weight = (k & 1 ? part_x : 1 - part_x) * (k >> 1 ? part_y : 1 - part_y);
            sum += weight * (perspective_ ? 1 / depth : depth), weights += weight;
        }
        if (!(weights > 0)) return kInfinity;
        const float linear = sum / weights;
        return (perspective_ ? 1 / linear : linear) - here.depth;
    }

  private:
    MapSpace space_;
    int x0_, y0_, width_, height_;
    bool perspective_;
    std::shared_ptr<const std::vector<float>> depths_;
};

}  // namespace

std::shared_ptr<const std::vector<float>> Textures::Impl::all_depths(const DepthMap& map,
                                                                     SourceLocation location) {
    const auto pixels = static_cast<int64_t>(map.view.x1 - map.view.x0) * (map.view.y1 - map.view.y0);
    if (pixels <= 0 || pixels > kMostPixels) {
        report_read_error(map.name, location, "too large to be kept, as the heights over it need");
        return nullptr;
    }
    const std::lock_guard lock(depths_mutex);
    std::weak_ptr<const std::vector<float>>& known = depths[map.name];
    if (auto kept = known.lock()) return kept;
    auto read = std::make_shared<std::vector<float>>();
    if (std::string problem = cache->read_depths(*map.map, *read); !problem.empty()) {
        report_read_error(map.name, location, std::move(problem));
        return nullptr;
    }
    known = read;
    return read;
}

DepthHeight Textures::height_over(std::string_view name, SourceLocation location,
                                  const M44f& camera_from_world) {
    const DepthMap* map = find_shadow(name, location);
    if (!map) return {};
    auto depths = impl_->all_depths(*map, location);
    if (!depths) return {};
    const auto heights = std::make_shared<const Heights>(map->view, camera_from_world, std::move(depths));
    return [heights](const V3f& p) { return heights->at(p); };
}

}  // namespace trapeze
