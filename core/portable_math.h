/// Elementary functions that give the same bits on every machine. Those of the system's libm do not: it has
/// them in several forms, with and without fused products, and takes the one that the processor runs
/// [decision 0028]. What decides a picture calls these; square roots and rounding are exact everywhere, and
/// are std's. tests/libm_calls holds our libraries to it. Inline, so that modules (core/files/module.h)
/// have them, too.
///
/// Errors are about a unit of the last place in double, and of tangents two. Floats are rounded from double;
/// the sine and cosine of angles below 120 are within .57 units and 1e-13.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

namespace trapeze::portable {

// Polynomials of sine and cosine in float are those of Arm's Optimized Routines, which glibc has, too. The
// others, and the reductions, are fdlibm's:
// Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved. Developed at SunPro, a Sun Microsystems,
// Inc. business. Permission to use, copy, modify, and distribute this software is freely granted, provided
// that this notice is preserved.
namespace parts {

/// The nearest whole number, without a call: where the sum is, doubles are 1 apart. Below 2^51.
inline double nearest(double x) {
    constexpr double kApart = 0x1.8p52;
    return (x + kApart) - kApart;
}

/// An angle as r + rest + quadrant * pi / 2 with |r| <= pi / 4.
struct Angle {
    double r, rest;
    int quadrant;
};

/// pi / 2 in three parts; products of the first two with whole numbers of up to 20 bits are exact.
constexpr double kHalfPi1 = 1.57079632673412561417e+00, kHalfPi2 = 6.07710050630396597660e-11,
                 kHalfPi3 = 2.02226624879595063154e-21;

inline Angle reduced(double x) {
    constexpr double kMost = 1 << 20;
    if (std::abs(x) > kMost) x = std::fmod(x, 2 * std::numbers::pi);  // no digits are left that would matter
    const double n = nearest(x * (2 / std::numbers::pi));
    const double first = x - n * kHalfPi1, second = n * kHalfPi2, r = first - second;
    const double third = n * kHalfPi3 - ((first - r) - second);
    Angle angle{r - third, 0, 0};
    angle.rest = (r - angle.r) - third;
    if (std::isfinite(n)) angle.quadrant = static_cast<int>(n) & 3;
    return angle;
}

inline double sine(const Angle& a) {
    const double z = a.r * a.r, v = z * a.r;
    const double r = 8.33333333332248946124e-03 +
                     z * (-1.98412698298579493134e-04 +
                          z * (2.75573137070700676789e-06 +
                               z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
    return a.r - ((z * (0.5 * a.rest - v * r) - a.rest) - v * -1.66666666666666324348e-01);
}

inline double cosine(const Angle& a) {
    const double z = a.r * a.r;
    const double r =
        z * (4.16666666666666019037e-02 +
             z * (-1.38888888888741095749e-03 +
                  z * (2.48015872894767294178e-05 +
                       z * (-2.75573143513906633035e-07 +
                            z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
    const double half = 0.5 * z, w = 1 - half;
    return w + (((1 - w) - half) + (z * r - a.r * a.rest));
}

/// The sine of the angle and `quadrants` right angles more.
inline double turned_sine(const Angle& a, int quadrants) {
    const int quadrant = (a.quadrant + quadrants) & 3;
    const double value = quadrant & 1 ? cosine(a) : sine(a);
    return quadrant & 2 ? -value : value;
}

/// Angles of floats below this have a way of their own, of fewer steps in double.
constexpr float kMostFloat = 120;

struct FloatAngle {
    double r, square;
    int quadrant;
};

inline FloatAngle reduced_float(float x) {
    const double wide = static_cast<double>(x), n = nearest(wide * (2 / std::numbers::pi));
    const double r = wide - n * (std::numbers::pi / 2);
    return {r, r * r, static_cast<int>(n) & 3};
}

inline double sine(const FloatAngle& a) {
    const double cube = a.r * a.square, low = a.r + cube * -0x1.555545995a603p-3;
    return low + cube * a.square * (0x1.1107605230bc4p-7 + a.square * -0x1.994eb3774cf24p-13);
}

inline double cosine(const FloatAngle& a) {
    const double fourth = a.square * a.square;
    const double low = 1 + a.square * -0x1.ffffffd0c621cp-2 + fourth * 0x1.55553e1068f19p-5;
    return low + fourth * a.square * (-0x1.6c087e89a359dp-10 + a.square * 0x1.99343027bf8c3p-16);
}

/// Of x >= 0.
inline double arc_tangent(double x) {
    constexpr double kHigh[] = {4.63647609000806093515e-01, 7.85398163397448278999e-01,
                                9.82793723247329054082e-01, 1.57079632679489655800e+00};
    constexpr double kLow[] = {2.26987774529616870924e-17, 3.06161699786838301793e-17,
                               1.39033110312309984516e-17, 6.12323399573676603587e-17};
    int part = -1;  // the angle is what is left and kHigh[part] + kLow[part]
    if (x >= 2.4375)
        part = 3, x = -1 / x;
    else if (x >= 1.1875)
        part = 2, x = (x - 1.5) / (1 + 1.5 * x);
    else if (x >= 0.6875)
        part = 1, x = (x - 1) / (x + 1);
    else if (x >= 0.4375)
        part = 0, x = (2 * x - 1) / (2 + x);
    constexpr double kTerms[] = {
        3.33333333333329318027e-01,  -1.99999999998764832476e-01, 1.42857142725034663711e-01,
        -1.11111104054623557880e-01, 9.09088713343650656196e-02,  -7.69187620504482999495e-02,
        6.66107313738753120669e-02,  -5.83357013379057348645e-02, 4.97687799461593236017e-02,
        -3.65315727442169155270e-02, 1.62858201153657823623e-02};
    const double z = x * x;
    double sum = 0;
    for (int i = 10; i >= 0; --i) sum = z * (kTerms[i] + sum);
    return part < 0 ? x - x * sum : kHigh[part] - ((x * sum - kLow[part]) - x);
}

/// ln 2 in two parts; products of the first one with exponents are exact.
constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;

/// Of x > 0.
inline double logarithm(double x) {
    int exponent = 0;
    double mantissa = std::frexp(x, &exponent);
    if (mantissa < std::numbers::sqrt2 / 2) mantissa *= 2, --exponent;
    const double f = mantissa - 1, s = f / (2 + f), z = s * s, k = exponent;
    const double sum =
        z * (6.666666666666735130e-01 +
             z * (3.999999999940941908e-01 +
                  z * (2.857142874366239149e-01 +
                       z * (2.222219843214978396e-01 +
                            z * (1.818357216161805012e-01 +
                                 z * (1.531383769920937332e-01 + z * 1.479819860511658591e-01))))));
    const double half = 0.5 * f * f;
    return k * kLn2High - ((half - (s * (half + sum) + k * kLn2Low)) - f);
}

}  // namespace parts

inline double sin(double x) {
    return parts::turned_sine(parts::reduced(x), 0);
}

inline double cos(double x) {
    return parts::turned_sine(parts::reduced(x), 1);
}

struct SineAndCosine {
    float sine, cosine;
};

/// Both of one angle take little longer than one.
inline SineAndCosine sine_and_cosine(float x) {
    if (!(std::abs(x) < parts::kMostFloat)) {
        const parts::Angle angle = parts::reduced(static_cast<double>(x));
        return {static_cast<float>(parts::turned_sine(angle, 0)),
                static_cast<float>(parts::turned_sine(angle, 1))};
    }
    const parts::FloatAngle angle = parts::reduced_float(x);
    const float s = std::abs(x) < 0x1p-12f ? x : static_cast<float>(parts::sine(angle));  // -0, too
    const float c = static_cast<float>(parts::cosine(angle));
    const bool turned = angle.quadrant & 1;
    const float sine = turned ? c : s, cosine = turned ? s : c;
    return {angle.quadrant & 2 ? -sine : sine, (angle.quadrant + 1) & 2 ? -cosine : cosine};
}

inline float sin(float x) {
    return sine_and_cosine(x).sine;
}

inline float cos(float x) {
    return sine_and_cosine(x).cosine;
}

inline double tan(double x) {
    const parts::Angle angle = parts::reduced(x);
    return parts::turned_sine(angle, 0) / parts::turned_sine(angle, 1);
}

inline double atan2(double y, double x) {
    const double up = std::abs(y), along = std::abs(x);
    double angle = up == 0 ? 0 : parts::arc_tangent(up / along);
    if (std::signbit(x)) angle = std::numbers::pi - (angle - 1.2246467991473531772e-16);
    return std::copysign(angle, y);
}

inline float atan2(float y, float x) {
    return static_cast<float>(atan2(static_cast<double>(y), static_cast<double>(x)));
}

/// Of -1 to 1.
inline float asin(float x) {
    const double wide = static_cast<double>(x);
    return static_cast<float>(atan2(wide, std::sqrt((1 - wide) * (1 + wide))));
}

inline double exp(double x) {
    if (x > 710) return std::numeric_limits<double>::infinity();
    if (x < -746) return 0;
    if (std::isnan(x)) return x;
    const double k = parts::nearest(x * std::numbers::log2e);
    const double high = x - k * parts::kLn2High, low = k * parts::kLn2Low, r = high - low, z = r * r;
    const double c = r - z * (1.66666666666666019037e-01 +
                              z * (-2.77777777770155933842e-03 +
                                   z * (6.61375632143793436117e-05 +
                                        z * (-1.65339022054652515390e-06 + z * 4.13813679705723846039e-08))));
    return std::ldexp(1 - ((low - r * c / (2 - c)) - high), static_cast<int>(k));
}

inline float exp2(float x) {
    const double wide = static_cast<double>(x), k = parts::nearest(wide);
    if (!(std::abs(wide) < 1000)) return static_cast<float>(exp(wide));  // 0, infinity or no number
    return static_cast<float>(std::ldexp(exp((wide - k) * std::numbers::ln2), static_cast<int>(k)));
}

/// Of x >= 0. Its error grows with the size of y * log(x): as many units of the last place.
inline double pow(double x, double y) {
    if (y == 0 || x == 1) return 1;
    if (x == 0 || std::isinf(x)) return (x == 0) == (y > 0) ? 0 : std::numeric_limits<double>::infinity();
    return exp(y * parts::logarithm(x));
}

inline float pow(float x, float y) {
    return static_cast<float>(pow(static_cast<double>(x), static_cast<double>(y)));
}

/// Of x >= 0.
inline double cbrt(double x) {
    if (!(x > 0) || std::isinf(x)) return x;
    const double y = exp(parts::logarithm(x) / 3);
    return y - (y * y * y - x) / (3 * y * y);
}

/// Without the steps that would keep squares from overflow.
inline double hypot(double x, double y) {
    return std::sqrt(x * x + y * y);
}

inline float hypot(float x, float y) {
    return static_cast<float>(hypot(static_cast<double>(x), static_cast<double>(y)));
}

/// Of the first kind and order 1, with an error below 1e-14: its integral over a circle, by a sum: what that
/// leaves out is a Bessel function of the order of its number of terms, which is next to nothing where that
/// is well above x.
inline double bessel_j1(double x) {
    const int terms = 40 + static_cast<int>(1.5 * std::abs(x));
    double sum = 0;
    for (int i = 0; i < terms; ++i) {
        const double angle = 2 * std::numbers::pi * i / terms;
        sum += cos(angle - x * sin(angle));
    }
    return sum / terms;
}

}  // namespace trapeze::portable
