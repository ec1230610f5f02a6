/// RISpec 4.2.5 to 4.2.8: bounds, levels of detail, and how geometry may be approximated.
#include <limits>

#include "pipeline/rib/requests/request_table.h"

namespace trapeze::rib {
namespace {

/// xmin xmax ymin ymax zmin zmax, in the current space. A box without thickness is allowed: a plane has a
/// size on the picture too.
std::vector<float> box(ArgumentCursor& c) {
    auto v = c.numbers(6, "the bound");
    for (int axis = 0; axis < 3; ++axis)
        if (v[2 * axis] > v[2 * axis + 1]) throw RequestError{"the bound is empty", {}};
    return v;
}

/// Primitives are bounded by themselves.
void bound(StateContext& r, ArgumentCursor& c) {
    box(c);
    r.report.count_without_effect();
}

/// The size is that of the bound as it is seen now; primitives to come are chosen by it (DetailRange).
void detail(StateContext& r, ArgumentCursor& c) {
    const std::vector<float> bound = box(c);
    if (r.state.in_object()) {
        r.report.warn_once("inside an object definition is not supported; ignored", "detail-in-object");
        return;
    }
    const float size = r.state.raster_area(bound);
    r.state.change_attributes().detail.size = size;
}

/// DetailRange minvisible lowertransition uppertransition maxvisible, in pixels; an end at infinity has no
/// transition.
void detail_range(StateContext& r, ArgumentCursor& c) {
    const auto v = c.numbers(4, "the range");
    if (!(v[0] <= v[1] && v[1] <= v[2] && v[2] <= v[3]))
        throw RequestError{"needs minvisible <= lowertransition <= uppertransition <= maxvisible", {}};
    const auto limit = [](float size) {
        return size >= kInfinity ? std::numeric_limits<float>::infinity() : size;
    };
    Detail& range = r.state.change_attributes(Own::DetailRange).detail;
    range.least = v[0], range.full_from = v[1], range.full_to = limit(v[2]), range.most = limit(v[3]);
}

/// GeometricApproximation type value (RISpec 4.2). The factors of motion and focus let blurred surfaces be
/// shaded more coarsely.
void geometric_approximation(StateContext& r, ArgumentCursor& c) {
    const std::string type = c.string("the type");
    const float value = c.number("the value");
    if (type == "motionfactor" || type == "focusfactor") {
        if (value < 0) throw RequestError{"the factor must not be negative", {}};
        const bool of_motion = type == "motionfactor";
        Attributes& a = changeable_attributes(r, of_motion ? Own::MotionFactor : Own::FocusFactor);
        (of_motion ? a.motion_factor : a.focus_factor) = value;
    } else if (type == "flatness") {  // which ShadingRate makes fine enough
        r.report.count_without_effect(" \"flatness\"");
    } else {
        r.report.warn_once(in_quotes(type) + " is not known; ignored", "approximation-" + type);
    }
}

/// What RISpec calls "primitive" and "smooth": there is one way to draw. Read so that a wrong one is found,
/// and counted as without effect.
void geometric_representation(StateContext& r, ArgumentCursor& c) {
    c.string("the type");
    r.report.count_without_effect();
}

constexpr RequestRow kDetailRequests[] = {
    {"Bound", bound},
    {"Detail", detail},
    {"DetailRange", detail_range},
    {"GeometricApproximation", geometric_approximation},
    {"GeometricRepresentation", geometric_representation},
};

}  // namespace

std::span<const RequestRow> detail_requests() {
    return kDetailRequests;
}

}  // namespace trapeze::rib
