#include "pipeline/ri/names.h"

#include <algorithm>

#include "composite/film/filters.h"
#include "pipeline/ri/errors.h"

// RISpec 5.2: rows and columns as in RiBasis. (Not const, as in RISpec: they are arguments of type RtBasis.)
RtBasis RiBezierBasis = {{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}};
RtBasis RiBSplineBasis = {{-1.0f / 6, 3.0f / 6, -3.0f / 6, 1.0f / 6},
                          {3.0f / 6, -6.0f / 6, 3.0f / 6, 0},
                          {-3.0f / 6, 0, 3.0f / 6, 0},
                          {1.0f / 6, 4.0f / 6, 1.0f / 6, 0}};
RtBasis RiCatmullRomBasis = {
    {-0.5f, 1.5f, -1.5f, 0.5f}, {1, -2.5f, 2, -0.5f}, {-0.5f, 0, 0.5f, 0}, {0, 1, 0, 0}};
RtBasis RiHermiteBasis = {{2, 1, -2, 1}, {-3, -2, 3, -1}, {0, 1, 0, 0}, {1, 0, 0, 0}};
RtBasis RiPowerBasis = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

namespace trapeze::ri {
namespace {

RtFloat filtered(const char* name, RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth) {
    return static_cast<RtFloat>(filter_value(name, double{x}, double{y}, double{xwidth}, double{ywidth}));
}

struct NamedFilter {
    RtFilterFunc filter;
    const char* name;
};

constexpr NamedFilter kFilters[] = {{RiGaussianFilter, "gaussian"},
                                    {RiBoxFilter, "box"},
                                    {RiTriangleFilter, "triangle"},
                                    {RiCatmullRomFilter, "catmull-rom"},
                                    {RiSincFilter, "sinc"},
                                    {RiDiskFilter, "disk"},
                                    {RiBesselFilter, "bessel"},
                                    {RiMitchellFilter, "mitchell"},
                                    {RiBlackmanHarrisFilter, "blackman-harris"}};

struct NamedBasis {
    const RtFloat (*basis)[4];
    const char* name;
};

}  // namespace

const char* filter_name(RtFilterFunc filter) {
    required(reinterpret_cast<const void*>(filter), "the filter");
    for (const NamedFilter& named : kFilters)
        if (named.filter == filter) return named.name;
    throw CallError{RIE_INCAPABLE, "the filter is a function of the program, which RIB cannot say"};
}

const char* basis_name(const RtFloat (*basis)[4]) {
    const NamedBasis kBases[] = {{RiBezierBasis, "bezier"},
                                 {RiBSplineBasis, "b-spline"},
                                 {RiCatmullRomBasis, "catmull-rom"},
                                 {RiHermiteBasis, "hermite"},
                                 {RiPowerBasis, "power"}};
    for (const NamedBasis& named : kBases)
        if (std::equal(&basis[0][0], &basis[0][0] + 16, &named.basis[0][0])) return named.name;
    return nullptr;
}

}  // namespace trapeze::ri

using trapeze::ri::filtered;

RtFloat RiGaussianFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth) {
    return filtered("gaussian", x, y, xwidth, ywidth);
}

RtFloat RiBoxFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth) {
    return filtered("box", x, y, xwidth, ywidth);
}

RtFloat RiTriangleFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth) {
    return filtered("triangle", x, y, xwidth, ywidth);
}

RtFloat RiCatmullRomFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth) {
    return filtered("catmull-rom", x, y, xwidth, ywidth);
}

RtFloat RiSincFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth) {
    return filtered("sinc", x, y, xwidth, ywidth);
}

RtFloat RiDiskFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth) {
    return filtered("disk", x, y, xwidth, ywidth);
}

RtFloat RiBesselFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth) {
    return filtered("bessel", x, y, xwidth, ywidth);
}

RtFloat RiMitchellFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth) {
    return filtered("mitchell", x, y, xwidth, ywidth);
}

RtFloat RiBlackmanHarrisFilter(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth) {
    return filtered("blackman-harris", x, y, xwidth, ywidth);
}
