/// Subdivision meshes where their limits are known: B-splines away from extraordinary vertices, at borders
/// and at sharp creases; the limit point and normal of vertices of any valence.
#include <cmath>

#include "tests/primitives/blends_harness.h"
#include "tests/primitives/dice_rib_harness.h"

namespace trapeze::testing {
namespace {

/// A sheet of so many vertices along each side, of which s and t are the numbers.
struct Sheet {
    int nu, nv;
    std::vector<V3d> points;

    Sheet(int u_points, int v_points) : nu(u_points), nv(v_points) {
        for (int j = 0; j < nv; ++j)
            for (int i = 0; i < nu; ++i) {
                const auto off = [&](uint32_t what) {
                    return std::floor(unit_float(hash(static_cast<uint32_t>(31 * j + i), what)) * 9) / 16 -
                           0.25;
                };
                points.emplace_back(0.75 * i - 2 + off(1), 0.75 * j - 2 + off(2), 2 * off(3));
            }
    }

    /// Beyond a border, points go on as the border's neighbours do: what the limit of the rule for borders
    /// and sharp creases comes to. [lo, hi]: the columns of the part on one side of a crease.
    V3d point(int i, int j, int lo, int hi) const {
        if (i < lo) return point(lo, j, lo, hi) * 2 - point(2 * lo - i, j, lo, hi);
        if (i > hi) return point(hi, j, lo, hi) * 2 - point(2 * hi - i, j, lo, hi);
        if (j < 0) return point(i, 0, lo, hi) * 2 - point(i, -j, lo, hi);
        if (j >= nv) return point(i, nv - 1, lo, hi) * 2 - point(i, 2 * (nv - 1) - j, lo, hi);
        return points[static_cast<size_t>(j * nu + i)];
    }
    ClosedForm bspline(double s, double t, int lo, int hi) const {
        const int i0 = static_cast<int>(s), j0 = static_cast<int>(t);
        return [this, i0, j0, lo, hi](double x, double y) {
            const auto u = kBases[1].blend(x - i0), v = kBases[1].blend(y - j0);
            V3d sum(0, 0, 0);
            for (int j = 0; j < 4; ++j)
                for (int i = 0; i < 4; ++i)
                    sum += point(i0 + i - 1, j0 + j - 1, lo, hi) *
                           (u[static_cast<size_t>(i)] * v[static_cast<size_t>(j)]);
            return sum;
        };
    }
    std::string text(const std::string& scheme, const std::string& tags) const {
        std::string counts, vertices, P, s, t;
        for (int j = 0; j < nv; ++j)
            for (int i = 0; i < nu; ++i) {
                const V3d& p = points[static_cast<size_t>(j * nu + i)];
                P += decimal(p.x) + decimal(p.y) + decimal(p.z);
                s += std::to_string(i) + " ", t += std::to_string(j) + " ";
                if (i + 1 == nu || j + 1 == nv) continue;
                counts += "4 ";
                for (const int at : {j * nu + i, j * nu + i + 1, (j + 1) * nu + i + 1, (j + 1) * nu + i})
                    vertices += std::to_string(at) + " ";
            }
        return "SubdivisionMesh \"" + scheme + "\" [" + counts + "] [" + vertices + "] " + tags + " \"P\" [" +
               P + "] \"varying float s\" [" + s + "] \"varying float t\" [" + t + "]";
    }
};

Tolerance of_meshes(double s0, double t0, double s1, double t1) {
    Tolerance tolerance;
    tolerance.position = 2e-6, tolerance.normal = 3e-5, tolerance.derivative = 2e-5, tolerance.regular = 0.05;
    tolerance.by_st = true;
    tolerance.begin = {s0, t0}, tolerance.end = {s1, t1};
    return tolerance;
}

/// Without a tag the outermost faces only shape the others.
TEST(SubdivisionForms, RegularMeshesAreBSplines) {
    const Sheet sheet(6, 5);
    for (const Placement& placement : placements()) {
        expect_pieces(
            sheet.text("catmull-clark", ""),
            [&](double s, double t) { return sheet.bspline(s, t, 0, sheet.nu - 1); }, placement,
            of_meshes(1, 1, 4, 3));
        expect_pieces(
            sheet.text("catmull-clark", "[\"interpolateboundary\"] [0 0] [] []"),
            [&](double s, double t) { return sheet.bspline(s, t, 0, sheet.nu - 1); }, placement,
            of_meshes(0, 0, 5, 4));
    }
}

TEST(SubdivisionForms, SharpCreasesCutBSplines) {
    const Sheet sheet(6, 5);
    const std::string tags =
        "[\"interpolateboundary\" \"crease\"] [1 0 5 1] [1 2 8 14 20 26] [10] []";  // the third column
    for (const Placement& placement : placements())
        expect_pieces(
            sheet.text("catmull-clark", tags),
            [&](double s, double t) {
                return s < 2 ? sheet.bspline(s, t, 0, 2) : sheet.bspline(s, t, 2, sheet.nu - 1);
            },
            placement, of_meshes(0, 0, 5, 4));
}

TEST(SubdivisionForms, BilinearMeshesAreTheirFaces) {
    const Sheet sheet(4, 4);
    for (const Placement& placement : placements())
        expect_pieces(
            sheet.text("bilinear", ""),
            [&](double s, double t) -> ClosedForm {
                const int i = static_cast<int>(s), j = static_cast<int>(t);
                return [&, i, j](double x, double y) {
                    const auto p = [&](int a, int b) {
                        return sheet.points[static_cast<size_t>((j + b) * sheet.nu + i + a)];
                    };
                    const double u = x - i, v = y - j;
                    return (p(0, 0) * (1 - u) + p(1, 0) * u) * (1 - v) +
                           (p(0, 1) * (1 - u) + p(1, 1) * u) * v;
                };
            },
            placement, of_meshes(0, 0, 3, 3));
}

/// [Halstead93]: the limit is (n^2 v + 4 e + f) / (n (n + 5)) with the sums of edge neighbours and of the
/// faces' far corners; the tangents are sums of both with cosines.
TEST(SubdivisionForms, VerticesOfEveryValence) {
    for (int n = 3; n <= 9; ++n) {
        std::vector<V3d> e, f;
        V3d centre(0.125, -0.25, 1), sum = centre * (n * n), along(0, 0, 0), across(0, 0, 0);
        std::string P = decimal(centre.x) + decimal(centre.y) + decimal(centre.z), counts, vertices;
        for (int i = 0; i < n; ++i) {
            const auto ring = [&](double turn, double radius, uint32_t what) {
                const double a = 2 * M_PI * (i + turn) / n;
                const auto eighths = [](double x) { return std::round(x * 64) / 64; };
                return V3d(
                    eighths(radius * std::cos(a)), eighths(radius * std::sin(a)),
                    eighths(0.5 * static_cast<double>(unit_float(hash(static_cast<uint32_t>(i), what)))));
            };
            e.push_back(ring(0, 1.5, 1)), f.push_back(ring(0.5, 2, 2));
            counts += "4 ";
            vertices += "0 " + std::to_string(1 + 2 * i) + " " + std::to_string(2 + 2 * i) + " " +
                        std::to_string(1 + 2 * ((i + 1) % n)) + " ";
            for (const V3d& p : {e.back(), f.back()}) P += decimal(p.x) + decimal(p.y) + decimal(p.z);
        }
        const double c = std::cos(2 * M_PI / n);
        const double edge = 1 + c + std::cos(M_PI / n) * std::sqrt(2 * (9 + c));
        for (int i = 0; i < n; ++i) {
            const size_t at = static_cast<size_t>(i);
            const double a = 2 * M_PI * i / n, b = 2 * M_PI * (i + 1) / n;
            sum += e[at] * 4.0 + f[at];
            along += e[at] * (edge * std::cos(a)) + f[at] * (std::cos(a) + std::cos(b));
            across += e[at] * (edge * std::sin(a)) + f[at] * (std::sin(a) + std::sin(b));
        }
        const V3d limit = sum / (n * (n + 5.0)), normal = along.cross(across).normalized();
        const std::string text = "SubdivisionMesh \"catmull-clark\" [" + counts + "] [" + vertices +
                                 "] [\"interpolateboundary\"] [1 0] [1] [] \"P\" [" + P + "]";
        for (const Placement& placement : placements()) {
            SCOPED_TRACE(text + placement.name);
            const DicedRib diced(placement.text() + text);
            EXPECT_THAT(diced.read.messages, ::testing::IsEmpty());
            const M44d normals_to_camera = placement.camera_from_object.inverse().transposed();
            V3d expected;
            normals_to_camera.multDirMatrix(normal, expected);
            expected = expected.normalized() * placement.outside;
            int found = 0;
            for (const DicedGrid& grid : diced.grids)
                for (const DicedVertex& vertex : grid.vertices) {
                    if (vertex.u != 0 || vertex.v != 0) continue;
                    ++found;
                    EXPECT_LE((vertex.P - in_camera_space(placement, limit)).length(), 5e-6);
                    EXPECT_LE((vertex.N - expected).length(), 2e-4);
                }
            EXPECT_EQ(found, n);
        }
    }
}

/// Every scheme, with creases, and vertices of valence 3 and 4.
TEST(SubdivisionForms, ClosedOnesHaveNoHoles) {
    const auto inside = [](uint32_t n) {
        return V3f(0.2f, 0.1f, 1.3f) + random_direction(n, 3) * 0.3f * unit_float(hash(n, 4));
    };
    const std::string place = "Translate 0.2 0.1 1.3 Rotate 20 1 2 3 ";
    const std::string box = "[4 4 4 4 4 4] [0 2 3 1 4 5 7 6 0 1 5 4 2 6 7 3 0 4 6 2 1 3 7 5] ";
    const std::string corners = " \"P\" [-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1]";
    for (const char* tags : {"", "[\"crease\"] [3 1] [0 1 3] [2.5]",
                             "[\"crease\" \"corner\"] [5 1 1 1] "
                             "[0 1 3 2 0 7] [10 4]"}) {
        expect_no_leaks(place + "SubdivisionMesh \"catmull-clark\" " + box + tags + corners, inside);
        expect_no_leaks(place + "SubdivisionMesh \"bilinear\" " + box + tags + corners, inside);
        expect_no_leaks(place +
                            "SubdivisionMesh \"loop\" [3 3 3 3 3 3 3 3] [0 1 4 1 2 4 2 3 4 3 0 4 1 0 5 2 1 "
                            "5 3 2 5 0 3 5] " +
                            (*tags ? "[\"crease\"] [3 1] [0 1 2] [2.5]" : "") +
                            " \"P\" [1 0 0 0 1 0 -1 0 0 0 -1 0 0 0 1 0 0 -1]",
                        [](uint32_t n) { return V3f(0.2f, 0.1f, 1.3f) + random_direction(n, 3) * 0.15f; });
    }
}

}  // namespace
}  // namespace trapeze::testing
