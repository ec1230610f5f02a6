/// What moves a transform, or the camera, of an AFF file in time: the keyframes of its name.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "pipeline/study/aff/aff_splines.h"

namespace trapeze {

/// Times from `begin` to before `end`.
struct AffSpan {
    double begin = -std::numeric_limits<double>::infinity();
    double end = std::numeric_limits<double>::infinity();
};

/// Spans in order that do not touch; one without ends: always; none: never.
using AffSpans = std::vector<AffSpan>;

/// The times that are in both.
AffSpans common_spans(const AffSpans& a, const AffSpans& b);
/// The time that is nearest to `time` and in a span, the end of a span too; `time` itself where there is no
/// span.
double nearest_in_spans(const AffSpans& spans, double time);

struct AffAnimation {
    std::optional<AffSpline> translation, scale;
    std::optional<AffRotationSpline> rotation;
    AffSpans visible{AffSpan()};

    /// Whether it ever moves what it is of. Being seen or not is no motion.
    bool moves() const { return translation || scale || rotation; }
    bool is_always_visible() const {
        return visible.size() == 1 && visible[0].begin == AffSpan().begin && visible[0].end == AffSpan().end;
    }
    /// Scales, then rotates, then translates.
    M44d matrix_at(double time) const;
};

/// The times when something is visible that is so until the first key, and then as the keys say.
struct AffVisibilityKey {
    double time;
    bool visible;
};
AffSpans visible_spans(const std::vector<AffVisibilityKey>& keys);

}  // namespace trapeze
