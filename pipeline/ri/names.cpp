#include "pipeline/ri/names.h"

#include <algorithm>

#include "composite/filters/filters.h"
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

struct NamedFilter {
    RtFilterFunc filter;
    const char* name;
};

/// Functions of ri.h and their names in RIB.
#define RI_FILTERS(FILTER)                    \
    FILTER(RiGaussianFilter, "gaussian")      \
    FILTER(RiBoxFilter, "box")                \
    FILTER(RiTriangleFilter, "triangle")      \
    FILTER(RiCatmullRomFilter, "catmull-rom") \
    FILTER(RiSincFilter, "sinc")              \
    FILTER(RiDiskFilter, "disk")              \
    FILTER(RiBesselFilter, "bessel")          \
    FILTER(RiMitchellFilter, "mitchell")      \
    FILTER(RiBlackmanHarrisFilter, "blackman-harris")

#define RI_NAMED_FILTER(function, name) {function, name},
constexpr NamedFilter kFilters[] = {RI_FILTERS(RI_NAMED_FILTER)};

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

// Weights of the film's own filters, for programs that call them.
#define RI_DEFINE_FILTER(function, name)                                                        \
    RtFloat function(RtFloat x, RtFloat y, RtFloat xwidth, RtFloat ywidth) {                    \
        return static_cast<RtFloat>(                                                            \
            trapeze::filter_value(name, double{x}, double{y}, double{xwidth}, double{ywidth})); \
    }
RI_FILTERS(RI_DEFINE_FILTER)
