#include "accel/moving/kd_planes.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "accel/builders/sah_topology.h"
#include "core/hyper_trapezoid.h"

namespace trapeze {
namespace {

/// Planes are tried at the ends of so many slabs along an axis; of small nodes of fewer.
constexpr size_t kMostKdSlabs = 32, kLeastKdSlabs = 8;

/// How far beyond all boxes the first and the last plane are, by the largest coordinate: more than boxes are
/// grown by for rounding, or what touches a cell would be on both sides of any plane there.
constexpr float kBesideBoxes = 4 * kBoundRounding;

/// References from which one node's sums are made in parallel, in parts that do not depend on threads.
constexpr size_t kParallelSumsFrom = 1 << 15;

/// The planes of one node along one axis, between kMost slabs at most, and the weights of what begins and
/// ends between them. Most nodes are small: to clear and copy room for more than they have takes longer than
/// their sums.
template <size_t kMost>
struct AxisPlanes {
    float first = 0, step = 0, steps_per_unit = 0;
    size_t count = 0;  ///< 0: none can be tried
    /// Weights that are at or below planes from this one on, or at or above planes down to this one.
    std::array<double, kMost + 2> low_from{}, high_to{};
    /// Weights of what crosses a plane while it moves.
    std::array<double, kMost + 1> low_part{}, high_part{};

    void divide(float from, float to, size_t slabs) {
        first = from, step = (to - from) / static_cast<float>(slabs);
        // No planes where slabs are so thin that floats hardly tell their ends apart.
        if (step > 0 && at(1) > from && at(slabs - 1) < at(slabs)) count = slabs + 1;
        steps_per_unit = 1 / step;
    }
    float at(size_t plane) const { return first + step * static_cast<float>(plane); }
    /// The first plane at or above a coordinate; `count`: none. What is said of planes decides costs alone,
    /// and may be wrong by what is rounded. Without std::ceil, which is a call where all machines are built
    /// for.
    size_t first_above(float x) const {
        const float place = (x - first) * steps_per_unit;
        if (!(place > 0)) return 0;
        if (!(place < static_cast<float>(count))) return count;
        const auto below = static_cast<uint32_t>(place);
        return below + (static_cast<float>(below) < place ? 1 : 0);
    }
    /// One more than the last plane at or below a coordinate; 0: none.
    size_t end_below(float x) const {
        const float place = (x - first) * steps_per_unit;
        if (!(place >= 0)) return 0;
        return place < static_cast<float>(count) ? static_cast<uint32_t>(place) + size_t{1} : count;
    }

    void add(const AxisPlanes& o) {
        for (size_t i = 0; i < low_from.size(); ++i) low_from[i] += o.low_from[i], high_to[i] += o.high_to[i];
        for (size_t i = 0; i < low_part.size(); ++i)
            low_part[i] += o.low_part[i], high_part[i] += o.high_part[i];
    }
};

/// Where the sides of a micropolygon's whole box are in the span of a reference to it: linear between knots,
/// which are the ends of the span and the keys between them.
class SidesOverTime {
  public:
    SidesOverTime(const SweptBoxes& boxes, size_t item, const ShutterSpan& when) {
        const std::span<const Box3f> keys = boxes.keys(item);
        add_knot(boxes.at(item, when.from), when.from);
        if (keys.size() == 1 || !(when.to > when.from)) return;
        const auto segments = static_cast<float>(keys.size() - 1);
        for (size_t key = 1; key + 1 < keys.size(); ++key) {
            const float time = static_cast<float>(key) / segments;
            if (time > when.from && time < when.to) add_knot(keys[key], time);
        }
        add_knot(boxes.at(item, when.to), when.to);
    }

    /// Sides are numbered: the lower ones of three axes, then the upper ones.
    struct Range {
        float least, most;
    };
    Range range(size_t side) const {
        const float* const at = values_[side];
        Range range{at[0], at[0]};
        for (size_t n = 1; n < count_; ++n)
            range = {std::min(range.least, at[n]), std::max(range.most, at[n])};
        return range;
    }

    /// Adds to parts[p] for planes `first` to `end` - 1 how long a side, moved by `shift`, is at or below
    /// them (`above`: at or above), from the first such time to the last.
    template <class Planes>
    void add_times(size_t side, float shift, bool above, const Planes& planes, size_t first, size_t end,
                   double* parts) const {
        if (first >= end) return;
        const float* const values = values_[side];
        if (count_ == 2) {
            const float length = times_[1] - times_[0], begin = values[0] + shift,
                        slope = length / (values[1] - values[0]);
            // From the beginning, as one that rises is below a plane, or to the end.
            const bool from_begin = (values[1] > values[0]) != above;
            for (size_t p = first; p < end; ++p) {
                const float crossing = std::clamp((planes.at(p) - begin) * slope, 0.0f, length);
                parts[p] += static_cast<double>(from_begin ? crossing : length - crossing);
            }
            return;
        }
        const float sign = above ? -1.0f : 1.0f;
        for (size_t p = first; p < end; ++p) {
            const float at = sign * (planes.at(p) - shift);
            float from = 2, to = -1;
            for (size_t n = 0; n + 1 < count_; ++n) {
                const float a = sign * values[n], b = sign * values[n + 1];
                if (a > at && b > at) continue;
                const float crossing = times_[n] + (at - a) / (b - a) * (times_[n + 1] - times_[n]);
                from = std::min(from, a > at ? crossing : times_[n]);
                to = b > at ? crossing : times_[n + 1];
            }
            parts[p] += static_cast<double>(std::max(0.0f, to - from));
        }
    }

  private:
    void add_knot(const Box3f& box, float time) {
        times_[count_] = time;
        for (int k = 0; k < 3; ++k) values_[k][count_] = box.min[k], values_[k + 3][count_] = box.max[k];
        ++count_;
    }

    size_t count_ = 0;
    float times_[kMaxKeyCount + 1], values_[6][kMaxKeyCount + 1];  // those of `count_` knots
};

/// Sums of a node's references over the planes of all axes.
template <size_t kMost>
struct PlaneSums {
    std::array<AxisPlanes<kMost>, 3> axis;
    /// What references reach beyond their boxes: a plane that close by has them on both sides.
    float margin = 0;

    /// `pose`: the micropolygon's whole box at the pose time. There a side of the reference's box is where
    /// the pose in the cell has it, and at other times moved by as much as the whole box: a guess, which
    /// decides costs alone.
    void add(const KdReference& reference, const SidesOverTime& sides, const Box3f& pose,
             KdTreeOptions::Weight weight) {
        const bool by_time = weight == KdTreeOptions::Weight::Time;
        const double whole = by_time ? static_cast<double>(reference.when.length()) : 1;
        for (int k = 0; k < 3; ++k) {
            AxisPlanes<kMost>& planes = axis[static_cast<size_t>(k)];
            if (planes.count == 0) continue;
            // Planes that a side moves across are looked at one by one. At those beyond it counts as a whole:
            // one entry, which consider_planes_of() carries on to the planes that follow.
            const auto part = [&](size_t side, float shift, bool above, size_t first, size_t end,
                                  double* parts) {
                if (by_time) return sides.add_times(side, shift, above, planes, first, end, parts);
                for (size_t p = first; p < end; ++p) parts[p] += 1;
            };
            const auto axis_side = static_cast<size_t>(k);
            const float down = reference.box.min[k] - margin - pose.min[k];
            const auto low = sides.range(axis_side);
            const size_t whole_from = planes.first_above(low.most + down);
            part(axis_side, down, false, planes.first_above(low.least + down), whole_from,
                 planes.low_part.data());
            planes.low_from[whole_from] += whole;
            const float up = reference.box.max[k] + margin - pose.max[k];
            const auto high = sides.range(axis_side + 3);
            const size_t whole_to = planes.end_below(high.least + up);
            part(axis_side + 3, up, true, whole_to, planes.end_below(high.most + up),
                 planes.high_part.data());
            planes.high_to[whole_to] += whole;
        }
    }
    void add(const PlaneSums& o) {
        for (size_t k = 0; k < 3; ++k) axis[k].add(o.axis[k]);
    }
};

/// Adds all references to a sum, which is zero, in parts of the same size whatever the number of threads:
/// floating-point sums depend on their order.
template <class Sum, class Add>
void add_in_parts(std::span<const KdReference> references, const Add& add, Sum& sum) {
    if (references.size() < kParallelSumsFrom) {
        for (const KdReference& reference : references) add(reference, sum);
        return;
    }
    const Sum zero = sum;
    sum = tbb::parallel_deterministic_reduce(
        tbb::blocked_range<size_t>(0, references.size(), kParallelSumsFrom / 4), zero,
        [&](const auto& range, const Sum& before) {
            Sum part = before;
            for (size_t i = range.begin(); i < range.end(); ++i) add(references[i], part);
            return part;
        },
        [](Sum a, const Sum& b) {
            a.add(b);
            return a;
        });
}

/// Those who may take part in the choice.
struct Voters {
    struct Group {
        size_t count = 0;
        double cost = 0;  ///< of testing them in a leaf
        Box3f box;        ///< poses, within the cell

        void add(const KdReference& reference, double weight) {
            ++count, cost += weight;
            box.extendBy(reference.box);
        }
        void add(const Group& o) {
            count += o.count, cost += o.cost;
            box.extendBy(o.box);
        }
    };
    Group residents, guests;

    void add(const Voters& o) { residents.add(o.residents), guests.add(o.guests); }
};

/// The cheapest plane of an axis, if it is cheaper than `best`.
template <size_t kMost>
void consider_planes_of(const AxisPlanes<kMost>& planes, int axis, const Box3f& cell, KdPlane& best) {
    if (planes.count == 0) return;
    // Sums from above of what lies at or above a plane; those from below are made on the way.
    std::array<double, kMost + 2> high_to_or_above;
    double above_all = 0;
    for (size_t p = planes.count + 1; p-- > 0;) high_to_or_above[p] = above_all += planes.high_to[p];
    const double cell_area = half_area(cell);
    double low = 0;
    for (size_t p = 0; p < planes.count; ++p) {
        low += planes.low_from[p];
        const float at = planes.at(p);
        if (!(at > cell.min[axis] && at < cell.max[axis])) continue;
        const double below = low + planes.low_part[p];
        const double above = high_to_or_above[p + 1] + planes.high_part[p];
        Box3f low_cell = cell, high_cell = cell;
        low_cell.max[axis] = high_cell.min[axis] = at;
        const double cost =
            kTraversalCost + (half_area(low_cell) * below + half_area(high_cell) * above) / cell_area;
        if (cost < best.cost) best = {cost, axis, at};
    }
}

}  // namespace

float KdPlanes::pose_time(const ShutterSpan& when) const {
    return std::clamp(options_.plane_time, when.from, when.to);
}

KdVote KdPlanes::vote(std::span<const KdReference> references, const Box3f& cell) const {
    const bool by_time = options_.weight == KdTreeOptions::Weight::Time;
    Voters voters;
    add_in_parts(
        references,
        [&](const KdReference& r, Voters& sum) {
            (r.guest ? sum.guests : sum.residents).add(r, by_time ? static_cast<double>(r.when.length()) : 1);
        },
        voters);
    const bool guests_too = voters.guests.count > voters.residents.count;
    Box3f extent = voters.residents.box;
    if (guests_too) extent.extendBy(voters.guests.box);
    KdVote vote;
    vote.leaf_cost = voters.residents.cost + (guests_too ? voters.guests.cost : 0);
    // Planes lie in the box of those who vote, hence a second pass over the references.
    const size_t slabs = std::clamp(references.size(), kLeastKdSlabs, kMostKdSlabs);
    if (slabs == kLeastKdSlabs)
        vote.best = best_plane<kLeastKdSlabs>(references, cell, extent, guests_too, slabs);
    else
        vote.best = best_plane<kMostKdSlabs>(references, cell, extent, guests_too, slabs);
    return vote;
}

/// `extent`: of those who vote.
template <size_t kMost>
KdPlane KdPlanes::best_plane(std::span<const KdReference> references, const Box3f& cell, const Box3f& extent,
                             bool guests_too, size_t slabs) const {
    float largest = 0;
    for (int k = 0; k < 3; ++k)
        largest = std::max({largest, std::abs(extent.min[k]), std::abs(extent.max[k])});
    // A plane at a side of a box leaves its owner on both sides: the first and last are a little beyond, and
    // cut off what is empty.
    const float beside = kBesideBoxes * largest;
    PlaneSums<kMost> sums;
    sums.margin = beside / 2;
    for (int k = 0; k < 3; ++k)
        sums.axis[static_cast<size_t>(k)].divide(extent.min[k] - beside, extent.max[k] + beside, slabs);
    add_in_parts(
        references,
        [&](const KdReference& r, PlaneSums<kMost>& sum) {
            if (!r.guest || guests_too)
                sum.add(r, SidesOverTime(boxes_, r.item, r.when), boxes_.at(r.item, pose_time(r.when)),
                        options_.weight);
        },
        sums);
    KdPlane best;
    for (int k = 0; k < 3; ++k) consider_planes_of(sums.axis[static_cast<size_t>(k)], k, cell, best);
    return best;
}

}  // namespace trapeze
