#include "shade/vm/kernels/color.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/vm/kernels/color.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/vm/kernels/operands-inl.h"

#ifndef TRAPEZE_SHADE_VM_COLOR_ONCE_
#define TRAPEZE_SHADE_VM_COLOR_ONCE_
namespace trapeze::vm {

/// The spaces of ctransform() and of casts (RISpec 3.2, section 11). Hue counts turns of the
/// circle, 0 to 1.
enum class ColorSpace : uint8_t { Rgb, Hsv, Hsl, Xyz, XyY, Yiq };

using ColorMatrix = std::array<std::array<double, 3>, 3>;

/// Inverts while compiling, in doubles, so that a colour that goes to a space and back comes out as it was
/// but for a rounding.
constexpr ColorMatrix inverse(const ColorMatrix& m) {
    ColorMatrix result{};
    double determinant = 0;
    for (size_t i = 0; i < 3; ++i) {
        const size_t a = (i + 1) % 3, b = (i + 2) % 3;
        determinant += m[0][i] * (m[1][a] * m[2][b] - m[1][b] * m[2][a]);
        for (size_t j = 0; j < 3; ++j) {
            const size_t c = (j + 1) % 3, d = (j + 2) % 3;
            result[i][j] = m[c][a] * m[d][b] - m[c][b] * m[d][a];
        }
    }
    for (auto& row : result)
        for (double& x : row) x /= determinant;
    return result;
}

/// Matrices from rgb to another space; each row makes one component of that space.
inline constexpr ColorMatrix kXyzFromRgb{{{0.412453, 0.357580, 0.180423},  // Rec. 709 with white D65
                                          {0.212671, 0.715160, 0.072169},
                                          {0.019334, 0.119193, 0.950227}}};
inline constexpr ColorMatrix kYiqFromRgb{
    {{0.299, 0.587, 0.114}, {0.596, -0.275, -0.321}, {0.212, -0.523, 0.311}}};
inline constexpr ColorMatrix kRgbFromXyz = inverse(kXyzFromRgb), kRgbFromYiq = inverse(kYiqFromRgb);

}  // namespace trapeze::vm
#endif

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

/// A row of a colour matrix times a colour.
HWY_INLINE V weigh(const std::array<double, 3>& row, const V3& c) {
    return dot(c.x, c.y, c.z, set(static_cast<float>(row[0])), set(static_cast<float>(row[1])),
               set(static_cast<float>(row[2])));
}
HWY_INLINE V3 weigh(const ColorMatrix& m, const V3& c) {
    return {weigh(m[0], c), weigh(m[1], c), weigh(m[2], c)};
}

/// 0 for a divisor of 0.
HWY_INLINE V ratio(V a, V b) {
    return hn::IfThenZeroElse(hn::Eq(b, hn::Zero(D())), hn::Div(a, b));
}

/// What hsv and hsl have in common: the hue, and the largest and least of the three components.
struct Hue {
    V hue, most, least;
};
/// Which component is largest decides the third of the circle, the difference of the two others where in it.
/// Grey has hue 0.
HWY_INLINE Hue hue_of(const V3& c) {
    const V most = at_least(at_least(c.x, c.y), c.z), least = at_most(at_most(c.x, c.y), c.z);
    const V sixth = ratio(set(1.0f / 6), hn::Sub(most, least));
    const V from_red = hn::Mul(hn::Sub(c.y, c.z), sixth);
    const V from_green = hn::Add(hn::Mul(hn::Sub(c.z, c.x), sixth), set(1.0f / 3));
    const V from_blue = hn::Add(hn::Mul(hn::Sub(c.x, c.y), sixth), set(2.0f / 3));
    V hue =
        hn::IfThenElse(hn::Eq(c.x, most), from_red, hn::IfThenElse(hn::Eq(c.y, most), from_green, from_blue));
    hue = hn::Add(hue, hn::IfThenElseZero(hn::Lt(hue, hn::Zero(D())), set(1)));
    return {hn::IfThenZeroElse(hn::Eq(most, least), hue), most, least};
}

/// How far the hue is along the hexagon from a primary's opposite: (offset + 6 hue) modulo 6.
HWY_INLINE V sector(V hue, float offset) {
    const V turns = hn::Add(hue, set(offset / 6));
    return hn::Mul(hn::Sub(turns, hn::Floor(turns)), set(6));
}
/// 1 near a primary's opposite and 0 near the primary.
HWY_INLINE V absence(V hue, float offset) {
    const V k = sector(hue, offset);
    return at_most(positive(at_most(k, hn::Sub(set(4), k))), set(1));
}

/// value is the largest component, saturation how far the least is below it, as a share. All of the
/// conversions work for colours brighter than 1 and darker than 0 as well.
HWY_INLINE V3 hsv_from_rgb(const V3& c) {
    const Hue h = hue_of(c);
    return {h.hue, ratio(hn::Sub(h.most, h.least), h.most), h.most};
}

/// Each channel is the value less what of the chroma its primary lacks at this hue: no case for each sixth of
/// the circle, and so no branch. The offsets 5, 3 and 1 belong to red, green and blue.
HWY_INLINE V3 rgb_from_hsv(const V3& c) {
    const V chroma = hn::Mul(c.y, c.z);
    return {hn::Sub(c.z, hn::Mul(chroma, absence(c.x, 5))), hn::Sub(c.z, hn::Mul(chroma, absence(c.x, 3))),
            hn::Sub(c.z, hn::Mul(chroma, absence(c.x, 1)))};
}
/// lightness is halfway between the largest and the least component.
HWY_INLINE V3 hsl_from_rgb(const V3& c) {
    const Hue h = hue_of(c);
    const V sum = hn::Add(h.most, h.least), lightness = hn::Mul(sum, set(0.5f));
    const V range = hn::IfThenElse(hn::Le(lightness, set(0.5f)), sum, hn::Sub(set(2), sum));
    return {h.hue, ratio(hn::Sub(h.most, h.least), range), lightness};
}

/// The same with lightness in the middle: the channels go as far above it as below.
HWY_INLINE V3 rgb_from_hsl(const V3& c) {
    const V half_chroma = hn::Mul(c.y, at_most(c.z, hn::Sub(set(1), c.z)));
    const auto channel = [&](float offset) HWY_ATTR {
        const V a = absence(c.x, offset);
        return hn::Add(c.z, hn::Mul(half_chroma, hn::Sub(set(1), hn::Add(a, a))));
    };
    return {channel(5), channel(3), channel(1)};
}
/// Chromaticity x, y and luminance Y.
HWY_INLINE V3 xyy_from_xyz(const V3& c) {
    const V scale_down = ratio(set(1), hn::Add(hn::Add(c.x, c.y), c.z));
    return {hn::Mul(c.x, scale_down), hn::Mul(c.y, scale_down), c.y};
}

/// Its inverse: a y of 0, which is black's, gives X = Z = 0 (ratio()).
HWY_INLINE V3 xyz_from_xyy(const V3& c) {
    const V scale_up = ratio(c.z, c.y);
    return {hn::Mul(c.x, scale_up), c.z, hn::Mul(hn::Sub(hn::Sub(set(1), c.x), c.y), scale_up)};
}

/// Every conversion goes through rgb, so that six spaces need ten functions and not thirty.
template <ColorSpace space>
HWY_INLINE V3 rgb_from(const V3& c) {
    if constexpr (space == ColorSpace::Hsv) return rgb_from_hsv(c);
    if constexpr (space == ColorSpace::Hsl) return rgb_from_hsl(c);
    if constexpr (space == ColorSpace::Xyz) return weigh(kRgbFromXyz, c);
    if constexpr (space == ColorSpace::XyY) return weigh(kRgbFromXyz, xyz_from_xyy(c));
    if constexpr (space == ColorSpace::Yiq) return weigh(kRgbFromYiq, c);
    return c;
}
template <ColorSpace space>
HWY_INLINE V3 from_rgb(const V3& c) {
    if constexpr (space == ColorSpace::Hsv) return hsv_from_rgb(c);
    if constexpr (space == ColorSpace::Hsl) return hsl_from_rgb(c);
    if constexpr (space == ColorSpace::Xyz) return weigh(kXyzFromRgb, c);
    if constexpr (space == ColorSpace::XyY) return xyy_from_xyz(weigh(kXyzFromRgb, c));
    if constexpr (space == ColorSpace::Yiq) return weigh(kYiqFromRgb, c);
    return c;
}

/// From a space to itself the colour is copied bit by bit and not sent by way of rgb, where it would be
/// rounded.
template <ColorSpace from, ColorSpace to>
void convert(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input in(o[1]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 c = in.get3(i);
        if constexpr (from == to)
            out.put3(c, i);
        else
            out.put3(from_rgb<to>(rgb_from<from>(c)), i);
    }
}

/// Instantiated for each pair of spaces, so that a kernel converts without looking at names or kinds.
template <ColorSpace from>
Kernel find_to(ColorSpace to) {
    switch (to) {
        case ColorSpace::Rgb:
            return convert<from, ColorSpace::Rgb>;
        case ColorSpace::Hsv:
            return convert<from, ColorSpace::Hsv>;
        case ColorSpace::Hsl:
            return convert<from, ColorSpace::Hsl>;
        case ColorSpace::Xyz:
            return convert<from, ColorSpace::Xyz>;
        case ColorSpace::XyY:
            return convert<from, ColorSpace::XyY>;
        case ColorSpace::Yiq:
            return convert<from, ColorSpace::Yiq>;
    }
    return nullptr;
}

/// Chooses the kernel that converts between two spaces. Both are part of its type: no kernel decides anything
/// by lane.
Kernel find_conversion(ColorSpace from, ColorSpace to) {
    switch (from) {
        case ColorSpace::Rgb:
            return find_to<ColorSpace::Rgb>(to);
        case ColorSpace::Hsv:
            return find_to<ColorSpace::Hsv>(to);
        case ColorSpace::Hsl:
            return find_to<ColorSpace::Hsl>(to);
        case ColorSpace::Xyz:
            return find_to<ColorSpace::Xyz>(to);
        case ColorSpace::XyY:
            return find_to<ColorSpace::XyY>(to);
        case ColorSpace::Yiq:
            return find_to<ColorSpace::Yiq>(to);
    }
    return nullptr;
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <optional>

namespace trapeze::vm {

HWY_EXPORT(find_conversion);

namespace {

/// Nothing for unknown names. Both spellings of YIQ and XYZ are in use.
std::optional<ColorSpace> color_space(std::string_view name) {
    constexpr std::pair<std::string_view, ColorSpace> kNames[] = {
        {"rgb", ColorSpace::Rgb}, {"hsv", ColorSpace::Hsv}, {"hsl", ColorSpace::Hsl},
        {"xyz", ColorSpace::Xyz}, {"XYZ", ColorSpace::Xyz}, {"xyY", ColorSpace::XyY},
        {"YIQ", ColorSpace::Yiq}, {"yiq", ColorSpace::Yiq},
    };
    for (const auto& [known, space] : kNames)
        if (known == name) return space;
    return std::nullopt;
}

}  // namespace

Kernel find_color_conversion(std::string_view from, std::string_view to) {
    const auto source = color_space(from), target = color_space(to);
    return source && target ? HWY_DYNAMIC_DISPATCH(find_conversion)(*source, *target) : nullptr;
}

}  // namespace trapeze::vm
#endif
