#include "sample/cut_hits.h"

#include <map>

namespace trapeze {

SolidState::SolidState(const std::vector<Solid>& solids)
    : solids_(solids),
      child_count_(solids.size()),
      holding_(solids.size()),
      first_holds_(solids.size()),
      inside_(solids.size()) {
    for (const Solid& solid : solids)
        if (solid.parent >= 0) ++child_count_[static_cast<size_t>(solid.parent)];
}

void SolidState::reset() {
    for (const int solid : touched_) {
        const auto s = static_cast<size_t>(solid);
        holding_[s] = 0, first_holds_[s] = false, inside_[s] = false;
    }
    touched_.clear();
}

bool SolidState::holds(int solid) const {
    const auto s = static_cast<size_t>(solid);
    switch (solids_[s].operation) {
        case Solid::Operation::Union:
            return holding_[s] > 0;
        case Solid::Operation::Intersection:
            return holding_[s] == child_count_[s];
        case Solid::Operation::Difference:
            return first_holds_[s] && holding_[s] == 1;
        case Solid::Operation::Primitive:
            break;
    }
    return inside_[s];
}

/// Flips whether the ray is inside a leaf, and tells its parents as long as that changes them. True when the
/// root changes: the surface then borders the whole solid.
bool SolidState::cross(int leaf) {
    int solid = leaf;
    touched_.push_back(solid);
    inside_[static_cast<size_t>(solid)] = !inside_[static_cast<size_t>(solid)];
    while (solids_[static_cast<size_t>(solid)].parent >= 0) {
        const Solid& child = solids_[static_cast<size_t>(solid)];
        const bool child_inside = inside_[static_cast<size_t>(solid)];
        solid = child.parent;
        const auto s = static_cast<size_t>(solid);
        touched_.push_back(solid);
        holding_[s] += child_inside ? 1 : -1;
        if (child.place == 0) first_holds_[s] = child_inside;
        const bool now = holds(solid);
        if (now == inside_[s]) return false;
        inside_[s] = now;
    }
    return true;
}

namespace {

/// Another method's hits without those that clipping planes or solids take away.
class CutVisibility : public Visibility {
  public:
    CutVisibility(std::unique_ptr<Visibility> method, const Scene& scene, const Grids& grids)
        : method_(std::move(method)), scene_(scene), grids_(grids) {}

    void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                 SampleStats& stats) const override {
        method_->resolve(samples, hits, scratch, stats);
        SolidState state(scene_.solids);
        std::map<int, bool> odd;
        size_t kept = 0;
        for (size_t s = 0; s < samples.size(); ++s) {
            const auto [first, last] = std::pair(hits.first[s], hits.first[s + 1]);
            hits.first[s] = static_cast<uint32_t>(kept);
            const std::span<const Hit> found(hits.hits.data() + first, last - first);
            start(found, state, odd);
            for (const Hit hit : found)
                if (is_kept(samples.rays[s], hit, state)) hits.hits[kept++] = hit;
        }
        hits.first[samples.size()] = static_cast<uint32_t>(kept);
        hits.hits.resize(kept);
    }
    BuildStats build_stats() const override { return method_->build_stats(); }
    int tile_side() const override { return method_->tile_side(); }

  private:
    const Grid& grid_of(const Hit& hit) const { return grids_.grids[MicropolygonId::unpack(hit.id).grid]; }
    int solid_of(const Hit& hit) const { return scene_.primitives[grid_of(hit).primitive].solid; }

    /// A ray that crosses a closed surface an odd number of times starts inside it. Only where an opaque hit
    /// ends the list is the number not known; such rays start outside.
    void start(std::span<const Hit> hits, SolidState& state, std::map<int, bool>& odd) const {
        state.reset();
        if (scene_.solids.empty() || hits.empty() || grid_of(hits.back()).opaque) return;
        odd.clear();
        for (const Hit& hit : hits)
            if (const int solid = solid_of(hit); solid >= 0) odd[solid] = !odd[solid];
        for (const auto& [solid, is_odd] : odd)
            if (is_odd) state.cross(solid);
    }

    bool is_kept(const AxisRay& ray, const Hit& hit, SolidState& state) const {
        const int solid = solid_of(hit);
        if (solid >= 0 && !state.cross(solid)) return false;
        const V3f at(ray.ox + ray.ux * hit.depth, ray.oy + ray.uy * hit.depth, hit.depth);
        for (const ClippingPlane& plane : scene_.clipping_planes)
            if (plane.normal.dot(at) < plane.distance) return false;
        return true;
    }

    const std::unique_ptr<Visibility> method_;
    const Scene& scene_;
    const Grids& grids_;
};

}  // namespace

std::unique_ptr<Visibility> with_cuts(std::unique_ptr<Visibility> method, const RenderContext& context,
                                      const Grids& grids) {
    const Scene* scene = context.scene;
    if (!method || !scene || (scene->solids.empty() && scene->clipping_planes.empty())) return method;
    return std::make_unique<CutVisibility>(std::move(method), *scene, grids);
}

}  // namespace trapeze
