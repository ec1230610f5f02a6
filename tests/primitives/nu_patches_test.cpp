/// NuPatch (RISpec 5.2) with any knots, orders, weights and ranges against Cox's and de Boor's recurrence as
/// it stands in books; its trim curves by area; and blobbies of one ball.
#include <algorithm>
#include <cmath>

#include "tests/primitives/blends_harness.h"
#include "tests/primitives/dice_rib_harness.h"

namespace trapeze::testing {
namespace {

struct Knots {
    int order;
    std::vector<double> knots;
    double begin, end;

    int points() const { return static_cast<int>(knots.size()) - order; }

    /// N(i, k) at x; with 0 / 0 as 0. `in`: the knot interval of x, whose polynomials go on beyond it.
    double basis(int i, int k, double x, int in) const {
        const auto at = [&](int n) { return knots[static_cast<size_t>(n)]; };
        if (k == 1) return i == in ? 1 : 0;
        const double left = at(i + k - 1) - at(i), right = at(i + k) - at(i + 1);
        return (left > 0 ? (x - at(i)) / left * basis(i, k - 1, x, in) : 0) +
               (right > 0 ? (at(i + k) - x) / right * basis(i + 1, k - 1, x, in) : 0);
    }
    int interval(double x) const {
        return static_cast<int>(std::upper_bound(knots.begin(), knots.end(), x) - knots.begin()) - 1;
    }
    std::string text() const {
        std::string t = std::to_string(points()) + " " + std::to_string(order) + " [";
        for (const double k : knots) t += decimal(k);
        return t + "] " + decimal(begin) + decimal(end);
    }
};

struct Surface {
    Knots u, v;
    std::vector<V3d> points;
    std::vector<double> weights;  ///< empty: not rational

    Surface(Knots along_u, Knots along_v, bool rational) : u(std::move(along_u)), v(std::move(along_v)) {
        for (int j = 0; j < v.points(); ++j)
            for (int i = 0; i < u.points(); ++i) {
                const auto off = [&](uint32_t what) {
                    return std::floor(unit_float(hash(static_cast<uint32_t>(31 * j + i), what)) * 9) / 16 -
                           0.25;
                };
                points.emplace_back(0.75 * i - 2 + off(1), 0.75 * j - 2 + off(2), 2 * off(3));
                if (rational) weights.push_back(1 + 2 * off(4));
            }
    }
    std::string text() const {
        std::string t = "NuPatch " + u.text() + v.text() + (weights.empty() ? "\"P\" [" : "\"Pw\" [");
        for (size_t i = 0; i < points.size(); ++i) {
            const double w = weights.empty() ? 1 : weights[i];
            for (int k = 0; k < 3; ++k) t += decimal(points[i][k] * w);
            if (!weights.empty()) t += decimal(w);
        }
        return t + "]";
    }
    PiecewiseForm form() const {
        return [this](double at_u, double at_v) -> ClosedForm {
            return [this, in_u = u.interval(at_u), in_v = v.interval(at_v)](double x, double y) {
                V3d sum(0, 0, 0);
                double weight = 0;
                for (int j = 0; j < v.points(); ++j)
                    for (int i = 0; i < u.points(); ++i) {
                        const size_t n = static_cast<size_t>(j * u.points() + i);
                        const double w = u.basis(i, u.order, x, in_u) * v.basis(j, v.order, y, in_v) *
                                         (weights.empty() ? 1 : weights[n]);
                        sum += points[n] * w, weight += w;
                    }
                return sum / weight;
            };
        };
    }
    Tolerance tolerance() const {
        Tolerance t;
        t.position = 2e-6, t.regular = 0.05, t.normal = 3e-5;
        t.begin = {u.begin, v.begin}, t.end = {u.end, v.end};
        return t;
    }
};

/// Clamped, even, uneven, with double and fourfold knots (there it jumps), of low and high order, in part.
const Knots kRows[] = {{4, {0, 0, 0, 0, 1, 1, 1, 1}, 0, 1},
                       {4, {0, 1, 2, 3, 4, 5, 6, 7, 8}, 3, 5},
                       {4, {-1, 0, 0, 0.5, 2, 2.25, 4, 5, 5.5}, 0.5, 2.25},
                       {3, {0, 0, 0, 1, 1, 2, 3, 3, 3}, 0.25, 2.5},
                       {4, {0, 0, 0, 0, 1, 1, 1, 1, 3, 3, 3, 3}, 0, 3},
                       {2, {0, 0, 1, 1.5, 4, 4}, 0, 4},
                       {2, {0, 0, 1, 1, 2, 2}, 0, 2},
                       {7, {0, 0, 0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2, 2}, 0, 2}};

TEST(NuPatchForms, EveryKnotVector) {
    size_t turn = 0;
    const std::vector<Placement> all = placements();
    for (const Knots& u : kRows)
        for (const Knots& v : kRows)
            for (const bool rational : {false, true}) {
                const Surface surface(u, v, rational);
                expect_pieces(surface.text(), surface.form(), all[turn++ % all.size()], surface.tolerance());
            }
}

/// What four rational arcs make of a circle is one, at every v.
TEST(NuPatchForms, RationalCircles) {
    const double d = std::sqrt(0.5),
                 ring[9][3] = {{1, 0, 1},   {1, 1, d},  {0, 1, 1},  {-1, 1, d}, {-1, 0, 1},
                               {-1, -1, d}, {0, -1, 1}, {1, -1, d}, {1, 0, 1}};
    const auto decimals = [](double x) {
        std::ostringstream text;
        text.precision(10);
        text << x << ' ';
        return text.str();
    };
    std::string Pw;
    for (const auto& [z, radius] : {std::pair{-1.0, 2.0}, {1.0, 1.0}})
        for (const auto& p : ring)
            Pw += decimals(radius * p[0] * p[2]) + decimals(radius * p[1] * p[2]) + decimals(z * p[2]) +
                  decimals(p[2]);
    const std::string text =
        "NuPatch 9 3 [0 0 0 1 1 2 2 3 3 4 4 4] 0 4 2 2 [0 0 1 1] 0 1 \"Pw\" [" + Pw + "]";
    for (const Placement& placement : placements()) {
        SCOPED_TRACE(placement.name);
        const DicedRib diced(placement.text() + text);
        const M44d to_object = placement.camera_from_object.inverse();
        double off = 0;
        for (const DicedGrid& grid : diced.grids)
            for (const DicedVertex& vertex : grid.vertices) {
                V3d p;
                to_object.multVecMatrix(vertex.P, p);
                off = std::max({off, std::abs(std::hypot(p.x, p.y) - (2 - vertex.v)),
                                std::abs(p.z - (2 * vertex.v - 1))});
            }
        EXPECT_LE(off, 1e-5);
        EXPECT_NEAR(diced.parameter_area(), 4, 1e-5);
    }
}

/// A circle's trim curve leaves its inside, or all but that, in the plane of the parameters.
TEST(NuPatchForms, TrimCurvesLeaveTheirArea) {
    // u w of the nodes: 0.5 w + 0.4 w times the square round the circle.
    std::string u, v, w;
    const double d = std::sqrt(0.5),
                 ring[9][3] = {{1, 0, 1},   {1, 1, d},  {0, 1, 1},  {-1, 1, d}, {-1, 0, 1},
                               {-1, -1, d}, {0, -1, 1}, {1, -1, d}, {1, 0, 1}};
    for (const auto& p : ring)
        u += decimal((0.5 + 0.4 * p[0]) * p[2]), v += decimal((0.5 + 0.4 * p[1]) * p[2]), w += decimal(p[2]);
    const std::string trim =
        "TrimCurve [1] [3] [0 0 0 1 1 2 2 3 3 4 4 4] [0] [4] [9] [" + u + "] [" + v + "] [" + w + "] ";
    const std::string patch =
        "NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [-4 -4 0 4 -4 0 -4 4 1 4 4 0]";
    const double area = M_PI * 0.16;
    for (const Placement& placement : placements()) {
        SCOPED_TRACE(placement.name);
        const std::string outside = "Attribute \"trimcurve\" \"sense\" \"outside\" ";
        EXPECT_NEAR(DicedRib(placement.text() + trim + patch).parameter_area(), area, 2e-4);
        EXPECT_NEAR(DicedRib(placement.text() + outside + trim + patch).parameter_area(), 1 - area, 2e-4);
    }
}

/// One ball of a blobby is drawn where (1 - r^2)^3 is 0.421875 = 0.75^3: at half its extent.
TEST(BlobbyForms, OneBallHasHalfItsExtent) {
    const std::vector<Placement> all = placements();
    for (const size_t i : {0, 2, 3, 4}) {
        const Placement& placement = all[i];
        SCOPED_TRACE(placement.name);
        const DicedRib diced(placement.text() + "ShadingRate 0.04 " +
                             "Blobby 1 [1001 0] [4 0 0 0  0 3 0 0  0 0 5 0  0.5 -0.25 0.125 1] [\"\"]");
        EXPECT_THAT(diced.read.messages, ::testing::IsEmpty());
        ASSERT_GT(diced.vertex_count(), 100u);
        const M44d to_object = placement.camera_from_object.inverse();
        double off = 0, worst = 1;
        for (const DicedGrid& grid : diced.grids)
            for (const DicedVertex& vertex : grid.vertices) {
                V3d p, normal;
                to_object.multVecMatrix(vertex.P, p);
                p -= V3d(0.5, -0.25, 0.125);
                const V3d local(p.x / 4, p.y / 3, p.z / 5);
                off = std::max(off, std::abs(local.length() - 0.5));
                to_object.transposed().multDirMatrix(V3d(local.x / 4, local.y / 3, local.z / 5), normal);
                worst = std::min(worst, normal.normalized().dot(vertex.N) * placement.outside);
            }
        EXPECT_LE(off, 0.005);
        EXPECT_GE(worst, 0.985);  // a cell's size of 0.16 on a curve of radius 0.9
    }
}

TEST(BlobbyForms, OneBallHasNoHoles) {
    expect_no_leaks(
        "ShadingRate 16 Translate 0.1 0.2 1.2 Blobby 2 [1001 0 1001 16 0 2 0 1] [1.5 0 0 0 0 1.5 0 0 0 0 1.5 "
        "0 0 0 0 1 "
        "1.5 0 0 0 0 1.5 0 0 0 0 1.5 0 0.5 0.2 0 1] [\"\"]",
        [](uint32_t n) {
            return V3f(0.1f, 0.2f, 1.2f) + random_direction(n, 3) * 0.4f * unit_float(hash(n, 4));
        },
        30'000);
}

}  // namespace
}  // namespace trapeze::testing
