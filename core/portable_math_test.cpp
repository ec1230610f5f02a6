#include "core/portable_math.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>

#include "core/random.h"

namespace trapeze {
namespace {

/// In [-1, 1), of 48 bits.
double number(uint32_t i) {
    return (hash(1, i) + hash(2, i) * 0x1p-32) * 0x1p-31 - 1;
}

constexpr uint32_t kNumbers = 200000;

/// How many units of the last place `value` is from what it should be.
double units_off(double value, long double expected) {
    const double nearest = static_cast<double>(expected);
    if (nearest == 0) return value == 0 ? 0 : 1e9;
    const double unit = std::nextafter(std::abs(nearest), 1e308) - std::abs(nearest);
    return static_cast<double>(std::abs(static_cast<long double>(value) - expected)) / unit;
}

template <class Function, class Reference>
void expect_near(const char* name, double scale, double most, Function&& function, Reference&& reference) {
    double worst = 0, at = 0;
    for (uint32_t i = 0; i < kNumbers / 10; ++i) {
        const double x = scale * number(i),
                     off = units_off(function(x), reference(static_cast<long double>(x)));
        if (!(off <= worst)) worst = off, at = x;
    }
    EXPECT_LE(worst, most) << name << " of " << at;
}

TEST(PortableMath, IsNextToTheLongDoublesOfLibm) {
    using Long = long double;
    for (const double scale : {1.0, 100.0, 1e6}) {
        expect_near(
            "sin", scale, 1, [](double x) { return portable::sin(x); }, [](Long x) { return std::sin(x); });
        expect_near(
            "cos", scale, 1, [](double x) { return portable::cos(x); }, [](Long x) { return std::cos(x); });
        expect_near(
            "tan", scale, 3, [](double x) { return portable::tan(x); }, [](Long x) { return std::tan(x); });
    }
    expect_near(
        "exp", 700, 1, [](double x) { return portable::exp(x); }, [](Long x) { return std::exp(x); });
    for (const double x : {-2.5, -1e-9, 0.3, 1e9})
        expect_near(
            "atan2", 10, 1.5, [x](double y) { return portable::atan2(y, x); },
            [x](Long y) { return std::atan2(y, static_cast<Long>(x)); });
    for (const double scale : {1.0, 1e30, 1e-300})
        expect_near(
            "cbrt", scale, 1, [](double x) { return portable::cbrt(std::abs(x)); },
            [](Long x) { return std::cbrt(std::abs(x)); });
    for (const double y : {0.45, 2.4, -1.0})
        expect_near(
            "pow", 8, 20, [y](double x) { return portable::pow(std::abs(x), y); },
            [y](Long x) { return std::pow(std::abs(x), static_cast<Long>(y)); });
    expect_near(
        "hypot", 1e3, 1.5, [](double x) { return portable::hypot(x, 7.0); },
        [](Long x) { return std::hypot(x, 7.0L); });
}

TEST(PortableMath, RoundsToTheNearestFloat) {
    const auto expect_float = [](const char* name, float scale, double most, auto&& function,
                                 auto&& reference) {
        constexpr double kLeast = 1e-13;  // where sine and cosine are next to 0
        for (uint32_t i = 0; i < kNumbers; ++i) {
            const float x = scale * static_cast<float>(number(i)), value = function(x);
            const double exact = reference(static_cast<double>(x));
            const float nearest = static_cast<float>(exact);
            const double unit =
                static_cast<double>(std::nextafter(std::abs(nearest), 1e38f) - std::abs(nearest));
            ASSERT_LE(std::abs(static_cast<double>(value) - exact), most * unit + kLeast)
                << name << " of " << x;
        }
    };
    for (const float scale : {1e-3f, 1.0f, 119.0f, 1e5f}) {
        expect_float(
            "sin", scale, 0.57, [](float x) { return portable::sin(x); },
            [](double x) { return std::sin(x); });
        expect_float(
            "cos", scale, 0.57, [](float x) { return portable::cos(x); },
            [](double x) { return std::cos(x); });
    }
    expect_float(
        "asin", 1, 0.501, [](float x) { return portable::asin(x); }, [](double x) { return std::asin(x); });
    expect_float(
        "exp2", 100, 0.501, [](float x) { return portable::exp2(x); }, [](double x) { return std::exp2(x); });
}

TEST(PortableMath, IsExactAtPlainPlaces) {
    EXPECT_EQ(portable::cos(0.0f), 1);
    EXPECT_TRUE(std::signbit(portable::sin(-0.0f)) && std::signbit(portable::sin(-0.0)));
    EXPECT_EQ(static_cast<float>(portable::tan(std::numbers::pi / 4)), 1);
    EXPECT_EQ(portable::asin(1.0f), static_cast<float>(std::numbers::pi / 2));
    EXPECT_EQ(portable::atan2(0.0, 0.0), 0);
    EXPECT_EQ(portable::atan2(0.0, -1.0), std::numbers::pi);
    EXPECT_EQ(portable::atan2(-1.0, 0.0), -std::numbers::pi / 2);
    EXPECT_EQ(portable::exp(0), 1);
    EXPECT_EQ(portable::exp(-1e9), 0);
    EXPECT_TRUE(std::isinf(portable::exp(1e9)) && std::isnan(portable::exp(NAN)));
    EXPECT_EQ(portable::exp2(-64.0f), 0x1p-64f);
    EXPECT_EQ(portable::pow(0.0, 0.45), 0);
    EXPECT_EQ(portable::pow(0.0, 0.0), 1);
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(portable::pow(0.0, -1.0), kInfinity);
    EXPECT_EQ(portable::pow(kInfinity, 0.5), kInfinity);
    EXPECT_EQ(portable::pow(kInfinity, -0.5), 0);
    EXPECT_EQ(portable::cbrt(0), 0);
    EXPECT_EQ(portable::cbrt(27), 3);
    EXPECT_EQ(portable::hypot(3.0f, 4.0f), 5);
}

/// Of whole numbers, from tables.
TEST(PortableMath, HasTheBesselFunctionOfFilters) {
    EXPECT_NEAR(portable::bessel_j1(0), 0, 1e-15);
    EXPECT_NEAR(portable::bessel_j1(1), 0.4400505857449335, 1e-15);
    EXPECT_NEAR(portable::bessel_j1(10), 0.0434727461688614, 1e-15);
    EXPECT_NEAR(portable::bessel_j1(100), -0.0771453520141122, 1e-14);
}

/// What this gives on any machine, with any compiler, by any libm.
TEST(PortableMath, HasTheSameBitsEverywhere) {
    uint64_t bits = 0;
    const auto mix = [&bits](auto value) {
        const auto wide = static_cast<double>(value);  // exact
        bits = (bits ^ std::bit_cast<uint64_t>(wide)) * 0x9e3779b97f4a7c15u;
        bits ^= bits >> 29;
    };
    for (uint32_t i = 0; i < kNumbers; ++i) {
        const double x = 30 * number(i), y = number(i + kNumbers);
        const float fx = static_cast<float>(x), fy = static_cast<float>(y);
        mix(portable::sin(x)), mix(portable::cos(x)), mix(portable::tan(x));
        mix(portable::sin(fx)), mix(portable::cos(fx)), mix(portable::asin(fy));
        mix(portable::atan2(x, y)), mix(portable::atan2(fx, fy)), mix(portable::exp(x)),
            mix(portable::exp2(fx));
        mix(portable::pow(std::abs(x), y)), mix(portable::pow(std::abs(fx), fy)),
            mix(portable::cbrt(std::abs(x)));
        mix(portable::hypot(x, y)), mix(portable::hypot(fx, fy));
        if (i % 1000 == 0) mix(portable::bessel_j1(x));
    }
    EXPECT_EQ(bits, 8181205468541016581u);
}

}  // namespace
}  // namespace trapeze
