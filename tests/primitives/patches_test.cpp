/// Patches and meshes of every type, basis, step and wrap (RISpec 5.2), polynomial and rational, against
/// blending functions written out one by one.
#include "tests/primitives/blends_harness.h"
#include "tests/primitives/dice_rib_harness.h"

namespace trapeze::testing {
namespace {

/// Bilinear meshes have two points a side and go on by one.
struct Axis {
    const NamedBasis* basis = nullptr;  ///< null: linear
    int patches = 1, points = 2, step = 1;
    bool wraps = false;

    std::vector<double> weights(double t) const {
        if (!basis) return {1 - t, t};
        const auto w = basis->blend(t);
        return {w.begin(), w.end()};
    }
};

Axis linear_axis(int patches, bool wraps) {
    return {nullptr, patches, wraps ? patches : patches + 1, 1, wraps};
}

Axis cubic_axis(const NamedBasis& basis, int patches, bool wraps) {
    return {&basis, patches, wraps ? patches * basis.step : 4 + (patches - 1) * basis.step, basis.step,
            wraps};
}

/// A net of points that may be anything, but where weights sum to 1 near a plane, so that normals are sure.
/// Eighths: text and numbers are the same.
struct Net {
    Axis u, v;
    std::vector<V3d> points;
    std::vector<double> weights;  ///< empty: not rational

    Net(const Axis& u_axis, const Axis& v_axis, uint32_t seed, bool rational) : u(u_axis), v(v_axis) {
        const auto eighths = [&](int a, int b, uint32_t what, int most) {
            return std::floor(unit_float(hash(seed + static_cast<uint32_t>(97 * a + b), what)) *
                              static_cast<float>(2 * most + 1)) /
                       8.0 -
                   most / 8.0;
        };
        for (int j = 0; j < v.points; ++j)
            for (int i = 0; i < u.points; ++i) {
                points.emplace_back(0.75 * (i - u.points / 2.0) + eighths(i, j, 1, 2),
                                    0.75 * (j - v.points / 2.0) + eighths(i, j, 2, 2), eighths(i, j, 3, 6));
                if (rational) weights.push_back(1 + eighths(i, j, 4, 4) / 2);
            }
    }

    std::string text() const {
        std::string t = weights.empty() ? "\"P\" [" : "\"Pw\" [";
        for (size_t i = 0; i < points.size(); ++i) {
            const double w = weights.empty() ? 1 : weights[i];
            for (int k = 0; k < 3; ++k) t += decimal(points[i][k] * w);
            if (!weights.empty()) t += decimal(w);
        }
        return t + "]";
    }

    ClosedForm piece(double at_u, double at_v) const {
        const int i0 = static_cast<int>(at_u * u.patches), j0 = static_cast<int>(at_v * v.patches);
        return [this, i0, j0](double x, double y) {
            const auto wu = u.weights(x * u.patches - i0), wv = v.weights(y * v.patches - j0);
            V3d sum(0, 0, 0);
            double weight = 0;
            for (size_t j = 0; j < wv.size(); ++j)
                for (size_t i = 0; i < wu.size(); ++i) {
                    const size_t at =
                        static_cast<size_t>((j0 * v.step + static_cast<int>(j)) % v.points) * u.points +
                        (i0 * u.step + static_cast<int>(i)) % u.points;
                    const double w = wu[i] * wv[j] * (weights.empty() ? 1 : weights[at]);
                    sum += points[at] * w;
                    weight += w;
                }
            return weights.empty() ? sum : sum / weight;
        };
    }
    PiecewiseForm pieces() const {
        return [this](double x, double y) { return piece(x, y); };
    }
};

std::string mesh_text(const char* type, const Net& net) {
    const auto side = [](const Axis& axis) {
        return std::to_string(axis.points) + (axis.wraps ? " \"periodic\" " : " \"nonperiodic\" ");
    };
    return std::string("PatchMesh \"") + type + "\" " + side(net.u) + side(net.v) + net.text();
}

/// Sums of large and small control points round as the large ones do.
Tolerance of_patches() {
    Tolerance tolerance;
    tolerance.position = 2e-6, tolerance.regular = 0.05, tolerance.normal = 3e-5;
    return tolerance;
}

TEST(PatchForms, Bilinear) {
    for (const bool rational : {false, true}) {
        const Net net(linear_axis(1, false), linear_axis(1, false), 3, rational);
        for (const Placement& placement : placements())
            expect_pieces("Patch \"bilinear\" " + net.text(), net.pieces(), placement, of_patches());
    }
}

TEST(PatchForms, HeightsOverTheUnitSquare) {
    for (const Placement& placement : placements())
        expect_form(
            "Patch \"bilinear\" \"Pz\" [1 2 3 -1]",
            [](double u, double v) { return V3d(u, v, (1 - v) * (1 + u) + v * (3 - 4 * u)); }, placement,
            of_patches());
}

TEST(PatchForms, BicubicOfEveryPairOfBases) {
    size_t turn = 0;
    for (const NamedBasis& u : kBases)
        for (const NamedBasis& v : kBases)
            for (const bool rational : {false, true}) {
                if (rational && !(u.is_affine && v.is_affine)) continue;  // weights that sum to 0
                const Net net(cubic_axis(u, 1, false), cubic_axis(v, 1, false), 5, rational);
                for (int k = 0; k < 3; ++k)
                    expect_pieces(basis_text(u, v, k == 0) + "Patch \"bicubic\" " + net.text(), net.pieces(),
                                  placements()[turn++ % placements().size()], of_patches());
            }
}

TEST(PatchForms, BilinearMeshesOfEveryWrap) {
    size_t turn = 0;
    for (const bool u_wraps : {false, true})
        for (const bool v_wraps : {false, true})
            for (const bool rational : {false, true}) {
                const Net net(linear_axis(4, u_wraps), linear_axis(3, v_wraps), 7, rational);
                for (int k = 0; k < 3; ++k)
                    expect_pieces(mesh_text("bilinear", net), net.pieces(),
                                  placements()[turn++ % placements().size()], of_patches());
            }
}

/// Patches of the power basis do not meet, unless their coefficients are made to.
TEST(PatchForms, BicubicMeshesOfEveryBasisAndWrap) {
    size_t turn = 0;
    for (const NamedBasis& u : kBases)
        for (const NamedBasis& v : kBases)
            for (const bool u_wraps : {false, true})
                for (const bool v_wraps : {false, true}) {
                    const bool rational = u.is_affine && v.is_affine && u_wraps == v_wraps;
                    const Net net(cubic_axis(u, u_wraps ? 4 : 3, u_wraps),
                                  cubic_axis(v, v_wraps ? 3 : 2, v_wraps), 11, rational);
                    expect_pieces(basis_text(u, v, false) + mesh_text("bicubic", net), net.pieces(),
                                  placements()[turn++ % placements().size()], of_patches());
                }
}

/// Steps that are not the basis' own leave gaps between patches, or lay them over each other.
TEST(PatchForms, MeshesOfOddSteps) {
    size_t turn = 0;
    for (const NamedBasis& named : kBases)
        for (int step = 1; step <= 4; ++step)
            for (const bool wraps : {false, true}) {
                NamedBasis basis = named;
                basis.step = step;
                const Net net(cubic_axis(basis, 4, wraps), cubic_axis(kBases[1], 2, false), 13, false);
                expect_pieces(basis_text(basis, kBases[1], true) + mesh_text("bicubic", net), net.pieces(),
                              placements()[turn++ % placements().size()], of_patches());
            }
}

TEST(PatchForms, BasesGivenAsMatrices) {
    // The blending functions' coefficients of t^3, t^2, t and 1, by rows (RISpec 5.2): here Bezier's, over
    // points in the reverse order.
    const std::string reversed = "Basis [1 -3 3 -1 0 3 -6 3 0 0 3 -3 0 0 0 1] 3 \"bezier\" 3 ";
    const Net net(cubic_axis(kBases[0], 1, false), cubic_axis(kBases[0], 1, false), 17, false);
    for (const Placement& placement : placements())
        expect_pieces(
            reversed + "Patch \"bicubic\" " + net.text(),
            [&](double, double) -> ClosedForm {
                return [&](double u, double v) { return net.piece(0, 0)(1 - u, v); };
            },
            placement, of_patches());
}

/// Closed round both ways: tori of every basis whose patches meet.
TEST(PatchForms, ClosedMeshesHaveNoHoles) {
    const auto in_tube = [](uint32_t n) {
        const float theta = 6.2831853f * unit_float(hash(n, 1));
        return V3f(std::cos(theta), std::sin(theta), 1.4f) + random_direction(n, 7) * 0.1f;
    };
    const auto torus = [](int nu, int nv) {
        std::string points = "\"P\" [";
        for (int j = 0; j < nv; ++j)
            for (int i = 0; i < nu; ++i) {
                const double a = 2 * 3.14159265358979 * i / nu, b = 2 * 3.14159265358979 * j / nv;
                const double r = 1 + 0.45 * std::cos(b);
                points += decimal(r * std::cos(a)) + decimal(r * std::sin(a)) + decimal(0.45 * std::sin(b));
            }
        return points + "]";
    };
    const std::string place = "Translate 0 0 1.4 ";
    expect_no_leaks(place + "PatchMesh \"bilinear\" 12 \"periodic\" 8 \"periodic\" " + torus(12, 8), in_tube);
    for (const char* basis : {"b-spline", "catmull-rom", "bezier"})
        expect_no_leaks(place + "Basis \"" + basis + "\" \"" + basis + "\" " +
                            "PatchMesh \"bicubic\" 15 \"periodic\" 12 \"periodic\" " + torus(15, 12),
                        in_tube);
}

/// A torus of Bezier patches, five by four, as the coefficients of its polynomials: what is made to meet
/// does.
TEST(PatchForms, ClosedMeshesOfCoefficientsHaveNoHoles) {
    constexpr int kMeshColumns = 5, kMeshRows = 4;
    const double bezier[4][4] = {{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}};
    const auto control = [](int i, int j) {
        const double a = 2 * 3.14159265358979 * i / (3 * kMeshColumns),
                     b = 2 * 3.14159265358979 * j / (3 * kMeshRows);
        const double r = 1 + 0.45 * std::cos(b);
        return V3d(r * std::cos(a), r * std::sin(a), 0.45 * std::sin(b));
    };
    std::string points = "\"P\" [";
    for (int v = 0; v < 4 * kMeshRows; ++v)
        for (int u = 0; u < 4 * kMeshColumns; ++u) {
            V3d coefficient(0, 0, 0);
            for (int j = 0; j < 4; ++j)
                for (int i = 0; i < 4; ++i)
                    coefficient +=
                        control(u / 4 * 3 + i, v / 4 * 3 + j) * (bezier[u % 4][i] * bezier[v % 4][j]);
            for (int k = 0; k < 3; ++k) points += decimal(coefficient[k]);
        }
    expect_no_leaks("Translate 0 0 1.4 Basis \"power\" \"power\" PatchMesh \"bicubic\" " +
                        std::to_string(4 * kMeshColumns) + " \"periodic\" " + std::to_string(4 * kMeshRows) +
                        " \"periodic\" " + points + "]",
                    [](uint32_t n) {
                        const float theta = 6.2831853f * unit_float(hash(n, 1));
                        return V3f(std::cos(theta), std::sin(theta), 1.4f) + random_direction(n, 7) * 0.1f;
                    });
}

}  // namespace
}  // namespace trapeze::testing
