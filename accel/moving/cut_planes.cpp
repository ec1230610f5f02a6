#include "accel/moving/cut_planes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "accel/moving/spatial_topology.h"

namespace trapeze {
namespace {

/// Planes are tried between so many slabs along an axis; of small nodes between fewer, for there are few
/// places where it matters.
constexpr size_t kMostSlabs = 16, kLeastSlabs = 4;

using Lanes = BoxLanes::Lanes;

/// The planes between slabs of a node's box, along all axes at once; none along one where coordinates are as
/// coarse as slabs, or slabs too thin to be counted.
template <size_t kSlabs>
struct Slabs {
    size_t count = 0;             ///< of slabs; up to kSlabs
    bool have[3] = {};            ///< by axis: there are planes
    float planes[3][kSlabs + 1];  ///< by axis, in order
    Lanes first{}, per_unit{}, last;

    Slabs(const Box3f& box, size_t references) : count(std::clamp(references / 4, kLeastSlabs, kSlabs)) {
        last = Lanes{} + static_cast<float>(count - 1);
        for (int axis = 0; axis < 3; ++axis) {
            float* const at = planes[axis];
            for (size_t i = 0; i <= count; ++i)
                at[i] = box.min[axis] +
                        (box.max[axis] - box.min[axis]) * (static_cast<float>(i) / static_cast<float>(count));
            const bool in_order =
                std::adjacent_find(at, at + count + 1, std::greater_equal<>()) == at + count + 1;
            const float slabs_per_unit = static_cast<float>(count) / (at[count] - at[0]);
            have[axis] = in_order && std::isfinite(slabs_per_unit);
            if (have[axis]) first[axis] = at[0], per_unit[axis] = slabs_per_unit;
        }
    }

    /// The slabs of a point along each axis; 0 where there are no planes. What is beside a plane may be
    /// rounded to either side of it, which changes what costs are taken to be, and nothing else.
    std::array<int32_t, 4> of(const Lanes& point) const {
        const Lanes none{};
        Lanes along = (point - first) * per_unit;
        along = along > none ? along : none;  // NaN, too
        along = along < last ? along : last;
        const auto slabs = __builtin_convertvector(along, Integers);
        return {slabs[0], slabs[1], slabs[2], 0};
    }

    /// The same along one axis.
    size_t of(const Lanes& point, int axis) const {
        return static_cast<size_t>(of(point)[static_cast<size_t>(axis)]);
    }

  private:
    using Integers = decltype(Lanes{} < Lanes{});
};

/// What begins and what ends in a slab: how much, and whole boxes.
struct InSlab {
    BoxSum of_begin, of_end;
    uint32_t begin = 0, end = 0;

    void begins(const BoxLanes& whole) { of_begin.add(whole), ++begin; }
    void ends(const BoxLanes& whole) { of_end.add(whole), ++end; }
};

/// The cheapest plane along an axis, where parts(i) are the boxes of what is below and above plane i. A
/// reference counts below if it begins below, and above if it ends above: what the plane cuts counts on both
/// sides [Stich09].
template <class Parts>
void consider_planes(std::span<const InSlab> in, const float* planes, int axis, size_t references,
                     double node_area, const Parts& parts, Cut& best) {
    const double visit = node_area * kTraversalCost;
    std::array<double, kMostSlabs> whole_area_above;
    BoxSum whole_above, whole_below;
    for (size_t i = in.size(); i-- > 1;) {
        whole_above.add(in[i].of_begin);
        whole_area_above[i] = half_area(whole_above.box());
    }
    Cut here;
    size_t low = 0, high = references;
    for (size_t i = 1; i < in.size(); ++i) {
        whole_below.add(in[i - 1].of_end);
        low += in[i - 1].begin, high -= in[i - 1].end;
        if (low == 0 || high == 0) continue;
        here.least = std::min(here.least, visit + half_area(whole_below.box()) * static_cast<double>(low) +
                                              whole_area_above[i] * static_cast<double>(high));
        const auto [low_box, high_box] = parts(i);
        const double cost = visit + half_area(low_box) * static_cast<double>(low) +
                            half_area(high_box) * static_cast<double>(high);
        if (cost < here.cost) here = {cost, axis, planes[i], low_box, high_box, low, high, here.least};
    }
    if (here.cost < best.cost) best = here;
}

/// The boxes below and above each plane, where boxes are cut without looking at what is in them: those of
/// what begins below and of what ends above, but for what the plane cuts off.
template <size_t kSlabs>
struct BoxesCut {
    int axis;
    const float* planes;
    std::array<BoxSum, kSlabs> below, above;  ///< by plane

    BoxesCut(std::span<const InSlab> in, const float* between, int along) : axis(along), planes(between) {
        for (size_t i = 1; i < in.size(); ++i) below[i] = below[i - 1], below[i].add(in[i - 1].of_begin);
        BoxSum sum;
        for (size_t i = in.size(); i-- > 1;) sum.add(in[i].of_end), above[i] = sum;
    }
    std::array<Box3f, 2> operator()(size_t i) const {
        BoxSum low = below[i], high = above[i];
        low.cut_above(axis, planes[i]), high.cut_below(axis, planes[i]);
        return {low.box(), high.box()};
    }
};

/// The same of what is in slabs, where polygons have been cut by all planes.
template <size_t kSlabs>
struct PolygonsCut {
    std::array<BoxSum, kSlabs> below, above;  ///< by plane

    explicit PolygonsCut(std::span<const BoxSum> in) {
        for (size_t i = 1; i < in.size(); ++i) below[i] = below[i - 1], below[i].add(in[i - 1]);
        BoxSum sum;
        for (size_t i = in.size(); i-- > 1;) sum.add(in[i]), above[i] = sum;
    }
    std::array<Box3f, 2> operator()(size_t i) const { return {below[i].box(), above[i].box()}; }
};

/// The cheapest plane along any axis where boxes are cut without looking at what is in them.
template <size_t kSlabs>
Cut cut_of_boxes(std::span<const SahItem> references, const Slabs<kSlabs>& slabs, double node_area) {
    std::array<std::array<InSlab, kSlabs>, 3> in;
    for (const SahItem& item : references) {
        const BoxLanes lanes(item.box);
        const LaneBox box(item.box);
        const auto firsts = slabs.of(box.low), lasts = slabs.of(box.high);
        for (size_t axis = 0; axis < 3; ++axis) {
            const auto first = static_cast<size_t>(firsts[axis]), last = static_cast<size_t>(lasts[axis]);
            in[axis][first].begins(lanes), in[axis][std::max(first, last)].ends(lanes);
        }
    }
    Cut best;
    for (int axis = 0; axis < 3; ++axis) {
        if (!slabs.have[axis]) continue;
        const float* const planes = slabs.planes[axis];
        const auto of_axis = std::span<const InSlab>(in[static_cast<size_t>(axis)]).first(slabs.count);
        consider_planes(of_axis, planes, axis, references.size(), node_area,
                        BoxesCut<kSlabs>(of_axis, planes, axis), best);
    }
    return best;
}

/// Polygons that wait for memory to tell where they are, and then are cut by all planes along an axis.
template <size_t kSlabs>
class PolygonCutter {
  public:
    PolygonCutter(const Slabs<kSlabs>& slabs, int axis, std::span<const LanePose> poses)
        : slabs_(slabs), axis_(axis), poses_(poses) {}

    /// One that is in several slabs.
    void add(const SahItem& item) {
        __builtin_prefetch(&poses_[PartId::index(item.id)]);
        waiting_[count_++] = &item;
        if (count_ == waiting_.size()) cut_waiting();
    }
    void cut_waiting() {
        for (const SahItem* item : std::span(waiting_).first(count_)) cut(*item);
        count_ = 0;
    }
    std::array<BoxSum, kSlabs> boxes;  ///< of what has been cut, by slab

  private:
    /// Slab by slab from below: what is left above a plane goes on to the next one.
    void cut(const SahItem& item) {
        LaneBox rest(item.box);
        const LanePose& pose = poses_[PartId::index(item.id)];
        const size_t last = slabs_.of(rest.high, axis_);
        for (size_t slab = slabs_.of(rest.low, axis_); slab < last && !rest.is_empty(); ++slab) {
            const LaneChopped parts = chop(pose, rest, axis_, slabs_.planes[axis_][slab + 1]);
            if (!parts.low.is_empty()) boxes[slab].add(parts.low.lanes());
            rest = parts.high;
        }
        if (!rest.is_empty()) boxes[last].add(rest.lanes());
    }

    const Slabs<kSlabs>& slabs_;
    int axis_;
    std::span<const LanePose> poses_;
    std::array<const SahItem*, 16> waiting_;
    size_t count_ = 0;
};

/// The cheapest plane along an axis where polygons are cut.
template <size_t kSlabs>
Cut cut_of_polygons(std::span<const SahItem> references, const Slabs<kSlabs>& slabs, int axis,
                    std::span<const LanePose> poses, double node_area) {
    std::array<InSlab, kSlabs> in;
    PolygonCutter<kSlabs> cutter(slabs, axis, poses);
    for (const SahItem& item : references) {
        const BoxLanes lanes(item.box);
        const LaneBox box(item.box);
        const size_t first = slabs.of(box.low, axis), last = std::max(first, slabs.of(box.high, axis));
        in[first].begins(lanes), in[last].ends(lanes);
        if (first == last)
            cutter.boxes[last].add(lanes);
        else
            cutter.add(item);
    }
    cutter.cut_waiting();
    Cut best;
    consider_planes(std::span<const InSlab>(in).first(slabs.count), slabs.planes[axis], axis,
                    references.size(), node_area,
                    PolygonsCut<kSlabs>(std::span(cutter.boxes).first(slabs.count)), best);
    return best;
}

template <size_t kSlabs>
Cut best_between(std::span<const SahItem> references, const Box3f& box, double to_beat,
                 std::span<const LanePose> poses, bool tight) {
    const Slabs<kSlabs> slabs(box, references.size());
    const Cut rough = cut_of_boxes(references, slabs, half_area(box));
    if (!tight || !std::isfinite(rough.cost)) return rough;
    if (!(rough.least < to_beat)) return {};
    return cut_of_polygons(references, slabs, rough.axis, poses, half_area(box));
}

}  // namespace

Cut CutPlanes::best(std::span<const SahItem> references, const Box3f& box, double to_beat) const {
    // Small nodes are most of all, and setting up so many slabs was most of their time.
    const auto between =
        references.size() < 4 * (kLeastSlabs + 1) ? best_between<kLeastSlabs> : best_between<kMostSlabs>;
    return between(references, box, to_beat, poses_, tight_);
}

LaneChopped CutPlanes::divided(const SahItem& reference, int axis, float at) const {
    const LaneBox box(reference.box);
    if (tight_) return chop(poses_[PartId::index(reference.id)], box, axis, at);
    LaneChopped parts{box, box};
    parts.low.high[axis] = parts.high.low[axis] = at;
    return parts;
}

}  // namespace trapeze
