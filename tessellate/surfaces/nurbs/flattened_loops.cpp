/// Trim curves (NURBS in the patch's parameter plane) as polylines fine enough to be followed point by point.
#include <algorithm>
#include <cmath>

#include "tessellate/surfaces/nurbs/knot_spans.h"
#include "tessellate/surfaces/nurbs/trimmed_patch.h"

namespace trapeze {
namespace {

using Imath::V2d;

/// How far a curve's middle may be from the line's, as part of the patch's range. Judged only from
/// kLeastDepth halvings on, for the middle of an S lies on its line.
constexpr double kLoopTolerance = 5e-5;
constexpr int kLeastDepth = 2, kMostDepth = 8;

/// Adds the points of one curve, in the order of its parameter.
class Flattener {
  public:
    Flattener(const NuPatch& patch, const TrimCurve& curve, std::vector<V2d>& out)
        : low_(patch.u_begin, patch.v_begin),
          size_(static_cast<double>(patch.u_end) - patch.u_begin,
                static_cast<double>(patch.v_end) - patch.v_begin),
          curve_(curve),
          spans_(curve.knots, curve.order, curve.begin, curve.end),
          out_(out) {}

    void run() {
        for (int span = 0; span < spans_.count(); ++span) {
            const V2d end = at(span, 1);
            // Order 2: a span is a line, which needs no halving.
            cut(span, 0, at(span, 0), 1, end, curve_.order == 2 ? kMostDepth : 0);
            add(end);
        }
    }

  private:
    /// The curve's point, u and v from 0 to 1 over the patch's range.
    V2d at(int span, float t) const {
        const BasisValues b = spans_.basis(span, t);
        double u = 0, v = 0, w = 0;
        for (int i = 0; i < curve_.order; ++i) {
            const V3f& p = curve_.points[b.first + i];
            u += b.value[i] * static_cast<double>(p.x);
            v += b.value[i] * static_cast<double>(p.y);
            w += b.value[i] * static_cast<double>(p.z);
        }
        return V2d((u / w - low_.x) / size_.x, (v / w - low_.y) / size_.y);
    }
    /// Adds a point, unless it repeats the one before or is no number.
    void add(const V2d& p) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
        if (out_.empty() || (out_.back() - p).length() > 1e-9) out_.push_back(p);
    }
    /// Points up to, but without, t = b.
    void cut(int span, float a, const V2d& from, float b, const V2d& to, int depth) {
        const float middle = (a + b) / 2;
        const V2d half = at(span, middle);
        const bool straight = depth >= kLeastDepth && (half - (from + to) * 0.5).length() <= kLoopTolerance;
        if (depth >= kMostDepth || straight) return add(from);
        cut(span, a, from, middle, half, depth + 1);
        cut(span, middle, half, b, to, depth + 1);
    }

    const V2d low_, size_;
    const TrimCurve& curve_;
    const KnotSpans spans_;
    std::vector<V2d>& out_;
};

}  // namespace

/// The curves of a loop follow each other head to tail (RISpec 5.2); what a file leaves open between them is
/// closed by a straight line.
std::vector<std::vector<V2d>> flattened_loops(const NuPatch& patch) {
    std::vector<std::vector<V2d>> loops;
    for (const std::vector<TrimCurve>& loop : patch.trim_loops) {
        std::vector<V2d> points;
        for (const TrimCurve& curve : loop) Flattener(patch, curve, points).run();
        while (points.size() > 1 && (points.front() - points.back()).length() <= 1e-9) points.pop_back();
        if (points.size() >= 3) loops.push_back(std::move(points));
    }
    return loops;
}

}  // namespace trapeze
