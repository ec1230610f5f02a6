/// B-spline basis functions over one knot vector, and its non-empty spans [Piegl97, ch. 2]. In double: knots
/// of orders up to 32 lose digits.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace trapeze {

/// The largest order (degree + 1) that patches and trim curves may have.
inline constexpr int kLargestOrder = 32;

/// The basis functions that are not 0 at a parameter, and their derivatives: those of control points
/// first .. first + order - 1. The rest of the arrays is 0.
struct BasisValues {
    int first = 0;
    std::array<double, kLargestOrder> value{}, slope{};
};

/// One direction of a NURBS, cut into its spans: the faces of a patch. Spans are counted from 0.
class KnotSpans {
  public:
    /// The part begin..end of the knots' range; knots never fall, there are points + order of them.
    KnotSpans(std::span<const float> knots, int order, float begin, float end);

    int count() const { return static_cast<int>(spans_.size()); }
    int order() const { return order_; }
    /// The knot interval of a span, counted from the first, empty ones too.
    int segment(int span) const { return spans_[span].knot - (order_ - 1); }
    /// The spline's parameter at 0..1 of a span; exact at its ends.
    double parameter(int span, float t) const;
    /// Length in the spline's parameter, of one span and of all together.
    double length(int span) const { return spans_[span].end - spans_[span].begin; }
    double total_length() const { return spans_.back().end - spans_.front().begin; }
    /// Where a span's share t is in the whole range and in its knot interval, both 0..1.
    float share_of_range(int span, float t) const;
    float share_of_segment(int span, float t) const;

    /// The share of the whole range at which a span begins.
    double begin_of_share(int span) const {
        return (spans_[span].begin - spans_.front().begin) / total_length();
    }
    /// How many spans lie before a share of the whole range, in spans and parts of them; goes on evenly
    /// beyond the range.
    double spans_before(double share) const;

    /// The basis functions at t, 0..1, of a span; their derivatives are by t.
    BasisValues basis(int span, float t) const;
    /// The weight of control point first + i in Bezier control point j of [lo, hi] of a span:
    /// weights[j * order + i].
    void bezier_weights(int span, float lo, float hi, std::span<double> weights) const;
    /// The first control point that bears on a span; order() of them do.
    int first_point(int span) const { return segment(span); }

  private:
    /// A part of a non-empty knot interval, cut to begin..end of the range.
    struct Span {
        int knot = 0;  ///< the knot before it
        double begin = 0, end = 1;
    };

    std::vector<double> knots_;
    int order_;
    std::vector<Span> spans_;
};

}  // namespace trapeze
