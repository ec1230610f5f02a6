#include "tessellate/surfaces/nurbs/knot_spans.h"

#include <algorithm>

namespace trapeze {

/// Empty knot intervals make no span: they only tell how smooth the curve is there.
KnotSpans::KnotSpans(std::span<const float> knots, int order, float begin, float end)
    : knots_(knots.begin(), knots.end()), order_(order) {
    // Knots order - 1 .. points bound the range where all basis functions add up to 1.
    const int points = static_cast<int>(knots.size()) - order;
    for (int i = order - 1; i < points; ++i) {
        const double from = std::max<double>(knots_[i], begin), to = std::min<double>(knots_[i + 1], end);
        if (from < to) spans_.push_back({i, from, to});
    }
}

double KnotSpans::parameter(int span, float t) const {
    const Span& s = spans_[span];
    return t == 1 ? s.end : s.begin + (s.end - s.begin) * static_cast<double>(t);
}

float KnotSpans::share_of_range(int span, float t) const {
    return static_cast<float>((parameter(span, t) - spans_.front().begin) / total_length());
}

/// The inverse of share_of_range() across all spans.
double KnotSpans::spans_before(double share) const {
    const double x = spans_.front().begin + share * total_length();
    const auto after = std::upper_bound(spans_.begin(), spans_.end(), x,
                                        [](double p, const Span& s) { return p < s.begin; });
    const auto span = after == spans_.begin() ? after : after - 1;
    return static_cast<double>(span - spans_.begin()) + (x - span->begin) / (span->end - span->begin);
}

float KnotSpans::share_of_segment(int span, float t) const {
    const int knot = spans_[span].knot;
    return static_cast<float>((parameter(span, t) - knots_[knot]) / (knots_[knot + 1] - knots_[knot]));
}

/// The recurrence of Cox and de Boor; derivatives come from the functions of one order less.
BasisValues KnotSpans::basis(int span, float t) const {
    const int knot = spans_[span].knot, degree = order_ - 1;
    const double x = parameter(span, t);
    BasisValues b;
    b.first = knot - degree;
    std::array<double, kLargestOrder> lower{};
    b.value[0] = 1;
    for (int d = 1; d <= degree; ++d) {
        if (d == degree) lower = b.value;
        double carried = 0;
        for (int i = 0; i < d; ++i) {
            const double right = knots_[knot + i + 1] - x, left = x - knots_[knot + 1 - d + i];
            const double part = b.value[i] / (right + left);  // over an interval that holds the span
            b.value[i] = carried + right * part;
            carried = left * part;
        }
        b.value[d] = carried;
    }
    if (degree == 0) return b;
    // By t, which runs over the span, and not by the spline's own parameter.
    const double scale = degree * length(span);
    for (int i = 0; i <= degree; ++i) {
        const auto share = [&](int j) {
            return lower[j] / (knots_[knot + j + 1] - knots_[knot + 1 - degree + j]);
        };
        b.slope[i] = scale * ((i > 0 ? share(i - 1) : 0.0) - (i < degree ? share(i) : 0.0));
    }
    return b;
}

/// Each Bezier control point is the blossom (polar form) with some of its arguments at lo and the rest at hi.
void KnotSpans::bezier_weights(int span, float lo, float hi, std::span<double> weights) const {
    const int knot = spans_[span].knot, degree = order_ - 1;
    const double from = parameter(span, lo), to = parameter(span, hi);
    for (int j = 0; j <= degree; ++j) {
        std::array<double, kLargestOrder> value{};
        value[0] = 1;
        for (int d = 1; d <= degree; ++d) {
            // Arguments in the order of the recurrence; a blossom does not depend on it.
            const double x = d <= degree - j ? from : to;
            double carried = 0;
            for (int i = 0; i < d; ++i) {
                const double right = knots_[knot + i + 1] - x, left = x - knots_[knot + 1 - d + i];
                const double part = value[i] / (right + left);
                value[i] = carried + right * part;
                carried = left * part;
            }
            value[d] = carried;
        }
        std::copy_n(value.begin(), order_, weights.begin() + j * order_);
    }
}

}  // namespace trapeze
