#include "shade/footprint_stretch.h"

#include <gtest/gtest.h>

#include <random>

namespace trapeze {
namespace {

/// The square of a matrix of two columns: what ellipse they span.
struct Square {
    float xx, xy, yy;
    Square(const V2f& a, const V2f& b)
        : xx(a.x * a.x + b.x * b.x), xy(a.x * a.y + b.x * b.y), yy(a.y * a.y + b.y * b.y) {}
    void expect_near(const Square& other, float tolerance) const {
        EXPECT_NEAR(xx, other.xx, tolerance);
        EXPECT_NEAR(xy, other.xy, tolerance);
        EXPECT_NEAR(yy, other.yy, tolerance);
    }
};

Square stretched(const V2f& u, const V2f& v, const Stretch& s) {
    return {u * s.uu + v * s.uv, u * s.uv + v * s.vv};
}

/// Columns that span neither next to nothing nor next to a line.
class Columns {
  public:
    V2f next() { return {number_(bits_), number_(bits_)}; }
    bool pair(V2f& a, V2f& b) {
        a = next(), b = next();
        return std::abs(a.x * b.y - a.y * b.x) > .2f;
    }

  private:
    std::minstd_rand bits_;
    std::uniform_real_distribution<float> number_{-1, 1};
};

TEST(FootprintStretch, SpansTheEllipseThatIsAskedFor) {
    Columns columns;
    int tried = 0;
    for (int i = 0; i < 1000; ++i) {
        V2f u, v, a, b;
        if (!columns.pair(u, v) || !columns.pair(a, b)) continue;
        stretched(u, v, stretch_to_ellipse(u, v, a, b, 0, true)).expect_near({a, b}, 1e-3f);
        ++tried;
    }
    EXPECT_GT(tried, 200);
}

TEST(FootprintStretch, HasNoAxisThatIsTooShort) {
    const V2f u(1, 0), v(0, 1);
    stretched(u, v, stretch_to_ellipse(u, v, {.5f, 0}, {0, .01f}, .1f, true))
        .expect_near({{.5f, 0}, {0, .1f}}, 1e-5f);
    stretched(u, v, stretch_to_ellipse(u, v, {0, 0}, {0, 0}, .1f, true))
        .expect_near({{.1f, 0}, {0, .1f}}, 1e-5f);
    // Along a diagonal, which is not shortened.
    const float half = std::sqrt(.5f);
    stretched(u, v, stretch_to_ellipse(u, v, {3 * half, 3 * half}, {0, 0}, 0, false))
        .expect_near({{3 * half, 3 * half}, {half, -half}}, 1e-4f);
    const Stretch none = stretch_to_ellipse(u, v, {.1f, 0}, {0, .2f}, 0, false);
    EXPECT_EQ(none.uu, 1);
    EXPECT_EQ(none.uv, 0);
    EXPECT_EQ(none.vv, 1);
}

TEST(FootprintStretch, IsBoundedWhereStepsAreSeenEdgeOn) {
    for (const V2f& v : {V2f(1, 0), V2f(0, 0), V2f(1, 1e-20f)}) {
        const Stretch s = stretch_to_ellipse({1, 0}, v, {1, 0}, {0, 1}, 0, true);
        if (s.is_finite()) {
            EXPECT_LE(std::max({s.uu, s.vv, std::abs(s.uv)}), kMostStretch * 1.01f);
        }
        const Stretch least = stretch_to_least({1, 0}, v, 1);
        EXPECT_TRUE(least.is_finite());
        EXPECT_LE(std::max(least.uu, least.vv), kMostStretch * 1.01f);
    }
}

}  // namespace
}  // namespace trapeze
