/// Curves of every basis, step and wrap (RISpec 5.6): centre lines against blending functions, widths, and
/// which way ribbons lie. Points (5.5) as disks.
#include <cmath>

#include "tests/primitives/blends_harness.h"
#include "tests/primitives/dice_rib_harness.h"

namespace trapeze::testing {
namespace {

/// Without skew: a ribbon's width has one length in them.
std::vector<Placement> rigid_placements() {
    const M44d plain(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.25, -0.5, 20, 1);
    const M44d turned(1.2, 0, 1.6, 0, 0, 2, 0, 0, -1.6, 0, 1.2, 0, 0.5, 0.25, 30, 1);  // twice as large
    M44d mirrored = turned;
    for (int j = 0; j < 3; ++j) mirrored[0][j] = -mirrored[0][j];
    return {{"plain", plain, "", 1},
            {"turned", turned, "", 1},
            {"mirrored", mirrored, "", 1},
            {"mirrored inside", mirrored, "Orientation \"inside\"", -1}};
}

/// One curve through its control points, as a form of v.
struct Line {
    const NamedBasis* basis;  ///< null: linear
    int step, segments;
    bool periodic;
    std::vector<V3d> points;

    Line(const NamedBasis* b, int s, int n, bool is_periodic, uint32_t seed)
        : basis(b), step(s), segments(n), periodic(is_periodic) {
        const int count = periodic ? n * s : (b ? 4 : 2) + (n - 1) * s;
        const auto eighths = [&](int i, uint32_t what) {
            return std::floor(17 * unit_float(hash(seed + static_cast<uint32_t>(i), what))) / 8.0 - 1;
        };
        for (int i = 0; i < count; ++i)
            points.emplace_back(eighths(i, 1) + i / 2.0, eighths(i, 2), eighths(i, 3) / 2);
    }
    int count() const { return static_cast<int>(points.size()); }

    /// In the segment in which `of` lies.
    V3d at(double v, double of) const {
        const int segment = std::min(static_cast<int>(of * segments), segments - 1);
        const double t = v * segments - segment;
        const auto point = [&](int i) { return points[static_cast<size_t>((segment * step + i) % count())]; };
        if (!basis) return point(0) * (1 - t) + point(1) * t;
        const auto w = basis->blend(t);
        V3d sum(0, 0, 0);
        for (int i = 0; i < 4; ++i) sum += point(i) * w[static_cast<size_t>(i)];
        return sum;
    }
    V3d slope(double v, double of) const {
        constexpr double h = 1e-5;
        return (at(v + h, of) - at(v - h, of)) / (2 * h);
    }

    std::string text() const {
        std::string t = std::string("Curves \"") + (basis ? "cubic" : "linear") + "\" [" +
                        std::to_string(count()) + "] " + (periodic ? "\"periodic\"" : "\"nonperiodic\"") +
                        " \"P\" [";
        for (const V3d& p : points)
            for (int k = 0; k < 3; ++k) t += decimal(p[k]);
        return t + "] ";
    }
};

struct Ribbon {
    std::string variables;
    std::function<double(double)> width;
    V3d normal{0, 0, 0};  ///< none: it faces the camera
};

/// Every vertex lies across the centre line, by its width, at its v; the outside faces the camera or along N.
void expect_ribbon(const Line& line, const Ribbon& ribbon, const Placement& placement) {
    const std::string basis = line.basis ? "Basis \"bezier\" 3 \"" + std::string(line.basis->name) + "\" " +
                                               std::to_string(line.step) + " "
                                         : "";
    const std::string text = basis + line.text() + ribbon.variables;
    SCOPED_TRACE(text + " (" + placement.name + ")");
    const DicedRib diced(placement.text() + text);
    EXPECT_THAT(diced.read.messages, ::testing::IsEmpty());
    ASSERT_GT(diced.vertex_count(), 0u);
    EXPECT_NEAR(diced.parameter_area(), 1, 1e-5);
    const M44d& to_camera = placement.camera_from_object;
    V3d normal, origin = in_camera_space(placement, {0, 0, 0});
    to_camera.multDirMatrix(ribbon.normal, normal);
    const double scale = (in_camera_space(placement, {1, 0, 0}) - origin).length();
    double off_width = 0, off_tangent = 0, off_plane = 0, turned_away = 0;
    for (const DicedGrid& grid : diced.grids)
        for (const DicedVertex& vertex : grid.vertices) {
            const double inwards = grid.middle().y > vertex.v ? 1e-6 : -1e-6;
            const V3d centre = in_camera_space(placement, line.at(vertex.v, vertex.v + inwards));
            const V3d across = vertex.P - centre;
            const double width = ribbon.width(vertex.v) * scale;
            off_width = std::max(off_width, std::abs(across.length() - std::abs(vertex.u - 0.5) * width));
            const V3d facing = ribbon.normal == V3d(0, 0, 0) ? V3d(0, 0, -1) : normal.normalized();
            turned_away = std::max(turned_away, -vertex.Ng.dot(facing) * placement.outside);
            // At a joint with a kink both segments lie across one of their tangents.
            double off_this = 1, off_facing = 1;
            for (const double side : {inwards, -inwards}) {
                V3d tangent;
                const double v = line.periodic ? vertex.v - std::floor(vertex.v + side) : vertex.v;
                to_camera.multDirMatrix(line.slope(v, v + side), tangent);
                off_this = std::min(off_this, std::abs(across.dot(tangent.normalized())));
                // Where a curve comes to rest, or runs along the line of sight, it has no sure direction.
                if (tangent.length() < 0.3 || tangent.normalized().cross(facing).length() < 0.3)
                    off_this = off_facing = 0;
            }
            off_tangent = std::max(off_tangent, off_this);
            off_plane = std::max(off_plane, off_facing == 0 ? 0 : std::abs(across.dot(facing)));
        }
    double size = 10;  // positions round as the largest numbers do
    for (const V3d& p : line.points) size = std::max(size, 2 * p.length() * scale);
    EXPECT_LE(off_width, 2e-6 * size);
    EXPECT_LE(off_tangent, 2e-6 * size);
    EXPECT_LE(off_plane, 2e-6 * size);
    EXPECT_LE(turned_away, 0);
}

/// Narrow where it curves: the normal of a wide ribbon turns over there.
std::vector<Ribbon> ribbons() {
    return {{"\"constantwidth\" [0.01]", [](double) { return 0.01; }},
            {"\"constantwidth\" [0.01] \"uniform normal N\" [0.6 0 -0.8]",
             [](double) { return 0.01; },
             {0.6, 0, -0.8}},
            {"", [](double) { return 1.0; }}};
}

TEST(CurveForms, EveryBasisStepAndWrap) {
    size_t turn = 0;
    const std::vector<Placement> all = rigid_placements();
    for (const NamedBasis& basis : kBases)
        for (int step = 1; step <= 4; ++step)
            for (const bool periodic : {false, true})
                for (int k = 0; k < 2; ++k, ++turn)
                    expect_ribbon(Line(&basis, step, periodic ? 6 : 5, periodic, 19), ribbons()[k],
                                  all[turn % all.size()]);
}

/// Between the joints of a straight line there is no mitre.
TEST(CurveForms, StraightLines) {
    Line line(nullptr, 1, 4, false, 0);
    for (size_t i = 0; i < line.points.size(); ++i)
        line.points[i] = V3d(1, 0.5, 0.25) * (0.5 * static_cast<double>(i * i));
    for (const Placement& placement : rigid_placements())
        for (const Ribbon& ribbon : ribbons()) expect_ribbon(line, ribbon, placement);
}

TEST(CurveForms, WidthsVary) {
    const Line line(&kBases[1], 1, 3, false, 23);
    for (const Placement& placement : rigid_placements()) {
        // Varying: linear from joint to joint. Vertex: by the basis, which keeps lines as they are.
        expect_ribbon(line,
                      {"\"varying float width\" [0 0.04 0.02 0.06]",
                       [](double v) {
                           const double x = 3 * v;
                           return x < 1 ? 0.04 * x : x < 2 ? 0.04 - 0.02 * (x - 1) : 0.02 + 0.04 * (x - 2);
                       }},
                      placement);
        expect_ribbon(line,
                      {"\"vertex float width\" [0.01 0.02 0.03 0.04 0.05 0.06]",
                       [](double v) { return 0.02 + 0.03 * v; }},
                      placement);
    }
}

/// Disks of many sides are a little smaller than their circles, those of few are made as large.
TEST(PointForms, DisksFaceTheCamera) {
    for (const Placement& placement : rigid_placements())
        for (const double width : {4.0, 0.7}) {
            SCOPED_TRACE(placement.name);
            const DicedRib diced(placement.text() + "Points \"P\" [0 0 0 2 1 0.5] \"constantwidth\" " +
                                 decimal(width));
            EXPECT_THAT(diced.read.messages, ::testing::IsEmpty());
            double area = 0;
            for (const DicedGrid& grid : diced.grids)
                for (int j = 0; j < grid.shape.nv; ++j)
                    for (int i = 0; i < grid.shape.nu; ++i) {
                        const V3d a = grid.at(i + 1, j + 1).P - grid.at(i, j).P,
                                  b = grid.at(i, j + 1).P - grid.at(i + 1, j).P;
                        area += std::abs(a.x * b.y - a.y * b.x) / 2;
                    }
            const double scale =
                (in_camera_space(placement, {1, 0, 0}) - in_camera_space(placement, {0, 0, 0})).length();
            EXPECT_NEAR(area, 2 * M_PI * width * width * scale * scale / 4, 2e-3 * area);
            const double depths[] = {in_camera_space(placement, {0, 0, 0}).z,
                                     in_camera_space(placement, {2, 1, 0.5}).z};
            for (const DicedGrid& grid : diced.grids)
                for (const DicedVertex& vertex : grid.vertices) {
                    EXPECT_LE(std::min(std::abs(vertex.P.z - depths[0]), std::abs(vertex.P.z - depths[1])),
                              1e-5);
                    EXPECT_NEAR(vertex.Ng.z, -placement.outside, 1e-5);
                }
        }
}

}  // namespace
}  // namespace trapeze::testing
