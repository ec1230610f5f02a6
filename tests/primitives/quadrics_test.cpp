/// The seven quadrics (RISpec 5.4): every partial sweep and range against the equations of the specification.
#include "tests/primitives/blends_harness.h"
#include "tests/primitives/dice_rib_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kDegree = 3.14159265358979323846 / 180;

/// Degrees. Backwards, more than once round, and very little.
const std::vector<double> kSweeps = {360, -360, 90, -135, 271, 720, -450, 3600, 0.5};

V3d turn(const V3d& p, double theta) {
    const double c = std::cos(theta), s = std::sin(theta);
    return {p.x * c - p.y * s, p.x * s + p.y * c, p.z};
}

/// A profile curve turned by the sweep, for every sweep; everywhere for the first two, in turns for the rest.
void expect_swept(const std::string& request, const std::string& numbers,
                  const std::function<V3d(double)>& profile, const Tolerance& tolerance = {}) {
    const std::vector<Placement> all = placements();
    for (size_t i = 0; i < kSweeps.size(); ++i) {
        const double theta = kSweeps[i] * kDegree;
        const ClosedForm form = [&](double u, double v) { return turn(profile(v), u * theta); };
        const std::string text = request + " " + numbers + decimal(kSweeps[i]);
        Tolerance wide = tolerance;
        // An angle of many turns is rounded as it is large.
        wide.position = wide.position * std::max(1.0, std::abs(kSweeps[i]) / 360);
        wide.normal = wide.normal * std::max(1.0, std::abs(kSweeps[i]) / 360);
        if (i < 2) {
            expect_form_everywhere(text, form, wide);
            continue;
        }
        for (size_t k = 0; k < 2; ++k) expect_form(text, form, all[(2 * i + k) % all.size()], wide, k == 0);
    }
}

struct SphereRange {
    double radius, zmin, zmax;
};

TEST(QuadricForms, Sphere) {
    for (const SphereRange& r : {SphereRange{1, -1, 1},
                                 {2, -1, 1.5},
                                 {2, -2, 0.5},
                                 {3, 1, 3},
                                 {2, 1.5, -1},
                                 {0.01, -0.01, 0.01},
                                 {-1.5, -1.5, 1.5},
                                 {-2, -1, 2}}) {
        const double lo = std::asin(r.zmin / r.radius), hi = std::asin(r.zmax / r.radius);
        expect_swept("Sphere", decimal(r.radius) + decimal(r.zmin) + decimal(r.zmax), [&](double v) {
            const double phi = lo + v * (hi - lo);
            return V3d(r.radius * std::cos(phi), 0, r.radius * std::sin(phi));
        });
    }
}

TEST(QuadricForms, Cone) {
    for (const auto& [height, radius] : {std::pair{2.0, 1.0}, {-1.5, 1.0}, {0.5, -2.0}, {3.0, 0.01}})
        expect_swept("Cone", decimal(height) + decimal(radius), [height = height, radius = radius](double v) {
            return V3d(radius * (1 - v), 0, height * v);
        });
}

TEST(QuadricForms, Cylinder) {
    for (const SphereRange& r : {SphereRange{1, -1, 1}, {2, 3, 4}, {0.5, 2, -2}, {-1, 0, 1}})
        expect_swept("Cylinder", decimal(r.radius) + decimal(r.zmin) + decimal(r.zmax),
                     [&](double v) { return V3d(r.radius, 0, r.zmin + v * (r.zmax - r.zmin)); });
}

TEST(QuadricForms, Hyperboloid) {
    const std::vector<std::pair<V3d, V3d>> lines = {{{1, 0, -1}, {0.5, 2, 2}},   // of one sheet
                                                    {{1, 0, 0}, {1, 0, 2}},      // a cylinder
                                                    {{1, 0.5, 1}, {0, 0, 1}},    // a disk
                                                    {{0, 0, -1}, {1, 1, 1}},     // a cone from its apex
                                                    {{2, -1, 0.5}, {1, 3, -1}},  // downwards
                                                    {{1, 0, 0}, {-1, 0, 0.5}}};  // through the axis
    for (const auto& [p1, p2] : lines) {
        const auto text = [](const V3d& p) { return decimal(p.x) + decimal(p.y) + decimal(p.z); };
        expect_swept("Hyperboloid", text(p1) + text(p2),
                     [p1 = p1, p2 = p2](double v) { return p1 + (p2 - p1) * v; });
    }
}

TEST(QuadricForms, Paraboloid) {
    for (const SphereRange& r :
         {SphereRange{1, 0.5, 2}, {2, 2.5, 3}, {1.5, 3, 1}, {1, -1, -2}, {-1, 0.25, 2}}) {
        // zmax is where the radius is rmax, whichever end is higher.
        expect_swept("Paraboloid", decimal(r.radius) + decimal(r.zmin) + decimal(r.zmax), [&](double v) {
            const double z = r.zmin + v * (r.zmax - r.zmin);
            return V3d(r.radius * std::sqrt(z / r.zmax), 0, z);
        });
    }
    // From the apex, where the derivative by v has no bounds: positions there, the rest away from it.
    Tolerance tolerance;
    tolerance.regular = 0.1;
    for (const Placement& placement : placements())
        expect_form(
            "Paraboloid 2 0 1.5 360",
            [](double u, double v) {
                return turn(V3d(2 * std::sqrt(std::max(v, 0.0)), 0, 1.5 * v), u * 360 * kDegree);
            },
            placement, tolerance);
}

TEST(QuadricForms, Disk) {
    for (const auto& [height, radius] : {std::pair{0.0, 1.0}, {-1.5, 2.0}, {0.5, -1.0}, {0.0, 0.01}})
        expect_swept("Disk", decimal(height) + decimal(radius), [height = height, radius = radius](double v) {
            return V3d(radius * (1 - v), 0, height);
        });
}

struct TorusRange {
    double major, minor, from, to;
};

TEST(QuadricForms, Torus) {
    for (const TorusRange& r : {TorusRange{2, 0.5, 0, 360},
                                {2, 0.5, 30, 300},
                                {2, 0.5, 180, -180},
                                {1, 0.25, -90, 90},
                                {1, 2, 0, 360},
                                {2, -0.5, 0, 360},
                                {-2, 0.5, 10, 200},
                                {1, 0.5, 0, 720}}) {
        Tolerance tolerance;
        tolerance.position *= 2, tolerance.normal *= 2;  // two angles
        expect_swept(
            "Torus", decimal(r.major) + decimal(r.minor) + decimal(r.from) + decimal(r.to),
            [&](double v) {
                const double phi = (r.from + v * (r.to - r.from)) * kDegree;
                return V3d(r.major + r.minor * std::cos(phi), 0, r.minor * std::sin(phi));
            },
            tolerance);
    }
}

/// Points, lines and nothing at all: whatever is diced is finite, with normals of unit length.
TEST(QuadricForms, ThoseWithoutAnAreaAreSurvived) {
    for (const char* text :
         {"Sphere 1 -1 1 0", "Sphere 1 0.5 0.5 360", "Sphere 1 1 1 360", "Cone 0 0 360", "Cone 1 0 360",
          "Cylinder 0 0 1 360", "Cylinder 1 1 1 360", "Disk 0 0 360", "Hyperboloid 1 0 0 1 0 0 360",
          "Hyperboloid 0 0 0 0 0 1 360", "Paraboloid 0 0 1 360", "Paraboloid 1 1 1 360",
          "Torus 0 0 0 360 360", "Torus 1 0 0 360 360", "Torus 1 0.5 0 0 360", "Disk 0 1 1e-30"}) {
        SCOPED_TRACE(text);
        const DicedRib diced(std::string("Translate 0 0 20 ") + text);
        EXPECT_THAT(diced.read.messages, ::testing::IsEmpty());
        for (const DicedGrid& grid : diced.grids)
            for (const DicedVertex& vertex : grid.vertices) {
                ASSERT_TRUE(std::isfinite(vertex.P.length()));
                ASSERT_NEAR(vertex.N.length(), 1, 1e-5);
            }
    }
}

/// What lies beyond a sphere or a paraboloid is left out, and said.
TEST(QuadricForms, RangesEndWithTheSurface) {
    const auto z_range = [](const DicedRib& diced) {
        std::pair<double, double> range(1e30, -1e30);
        for (const DicedGrid& grid : diced.grids)
            for (const DicedVertex& vertex : grid.vertices)
                range = {std::min(range.first, vertex.P.z - 20), std::max(range.second, vertex.P.z - 20)};
        return range;
    };
    struct {
        const char* text;
        double lo, hi;
        const char* message;
    } const rows[] = {
        {"Sphere 2 -5 1 360", -2, 1, "zmin"},     {"Sphere 2 -1 7 360", -1, 2, "zmax"},
        {"Sphere -2 -5 1 360", -2, 1, "zmin"},    {"Paraboloid 1 -1 2 360", 0, 2, "zmin"},
        {"Paraboloid 1 1 -2 360", -2, 0, "zmin"}, {"Sphere 1 -1.0000001 1 360", -1, 1, nullptr}};
    for (const auto& row : rows) {
        SCOPED_TRACE(row.text);
        const DicedRib diced(std::string("Translate 0 0 20 ") + row.text);
        if (row.message)
            EXPECT_THAT(diced.read.messages, ElementsAre(HasSubstr(row.message)));
        else
            EXPECT_THAT(diced.read.messages, ::testing::IsEmpty());
        EXPECT_NEAR(z_range(diced).first, row.lo, 5e-6);
        EXPECT_NEAR(z_range(diced).second, row.hi, 5e-6);
    }
}

/// Numbers that only make work are cut down, and said.
TEST(QuadricForms, TurnsEndSomewhere) {
    for (const char* text : {"Sphere 1 -1 1 1e30", "Disk 0 1 -1e9", "Torus 1 0.5 0 1e20 360",
                             "Torus 1 0.5 10 -1e6 -1e6", "Cone 1 1 3601"}) {
        SCOPED_TRACE(text);
        const DicedRib diced(std::string("Translate 0 0 20 ") + text);
        EXPECT_THAT(diced.read.messages, ElementsAre(HasSubstr("more than ten times")));
        EXPECT_GT(diced.vertex_count(), 100u);
        EXPECT_LT(diced.vertex_count(), 200'000u);
        EXPECT_NEAR(diced.parameter_area(), 1, 1e-3);
    }
}

/// Sweeps of any number of whole turns close (odd ones: the others are left as often as they are entered).
TEST(QuadricForms, ClosedOnesHaveNoHoles) {
    const auto in_ball = [](uint32_t n) {
        return V3f(0.3f, 0.2f, 1.1f) + random_direction(n, 7) * 0.8f * std::cbrt(unit_float(hash(n, 8)));
    };
    for (const char* range : {"-1 1 360", "-1 1 -360", "1 -1 360", "-1 1 1080", "-1 1 -1080", "-3 3 360"})
        expect_no_leaks(std::string("Translate 0.3 0.2 1.1 Scale 1 1 -1 Sphere 1 ") + range, in_ball);
    expect_no_leaks("Translate 0.3 0.2 1.1 Sphere -1 -1 1 360", in_ball);
    const auto in_tube = [](uint32_t n) {
        const float theta = 6.2831853f * unit_float(hash(n, 1));
        return V3f(std::cos(theta), std::sin(theta), 1.3f) + random_direction(n, 7) * 0.2f;
    };
    for (const char* range : {"0 360 360", "-180 180 -360", "360 0 360", "17 377 1080"})
        expect_no_leaks(std::string("Translate 0 0 1.3 Torus 1 0.3 ") + range, in_tube);
}

}  // namespace
}  // namespace trapeze::testing
