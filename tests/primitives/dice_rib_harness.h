/// For tests: primitives as RIB gives them, through the reader and the dicer, next to closed forms that know
/// nothing of either. Closed forms are in double; the derivatives and normals that belong to them come from
/// their positions alone.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/rib/reading_harness.h"
#include "tessellate/dicing_harness.h"
#include "tessellate/leak_harness.h"

namespace trapeze::testing {

/// Object-space position at (u, v).
using ClosedForm = std::function<V3d(double, double)>;
/// The same of what has pieces: that of the piece in which a place lies, going on beyond it.
using PiecewiseForm = std::function<ClosedForm(double u, double v)>;

/// A vertex of a grid, camera space.
struct DicedVertex {
    V3d P, N, Ng, dPdu, dPdv;
    double u = 0, v = 0, s = 0, t = 0;
    bool is_border = false;  ///< of its grid: may have been moved onto its edge's vertices
};

struct DicedGrid {
    GridShape shape;
    std::vector<DicedVertex> vertices;

    const DicedVertex& at(int i, int j) const { return vertices[shape.row_index(i, j)]; }
    Imath::V2d middle() const {
        return {(vertices.front().u + vertices.back().u) / 2, (vertices.front().v + vertices.back().v) / 2};
    }
};

/// RIB text as a world of which all is diced: what is outside of the view might be displaced into it.
struct DicedRib {
    ReadOutcome read;
    TestScene scene;
    std::vector<DicedGrid> grids;

    explicit DicedRib(const std::string& world, const std::string& before_world = "")
        : read(read_text(
              "Format 60 60 1 ScreenWindow -12 12 -12 12 Projection \"orthographic\" Clipping 0.01 1000 " +
              before_world + "\nWorldBegin Attribute \"displacementbound\" \"sphere\" 1e4\n" + world +
              "\nWorldEnd\n")) {
        if (read.worlds.empty()) return;
        scene.scene = std::move(read.worlds[0]);
        const RenderContext context = scene.context();
        const Tessellation tessellation(context);
        DiceScratch scratch;
        ShadingGrid grid;
        for (size_t i = 0; i < tessellation.subpatches().size(); ++i) {
            tessellation.dice(i, grid, scratch);
            add(grid);
        }
    }

    size_t vertex_count() const {
        size_t count = 0;
        for (const DicedGrid& grid : grids) count += grid.vertices.size();
        return count;
    }

    /// Of the micropolygons in the plane of (u, v): 1 when they cover the unit square once.
    double parameter_area() const {
        double area = 0;
        for (const DicedGrid& grid : grids)
            for (int j = 0; j < grid.shape.nv; ++j)
                for (int i = 0; i < grid.shape.nu; ++i) {
                    const DicedVertex &a = grid.at(i, j), &b = grid.at(i + 1, j), &c = grid.at(i + 1, j + 1),
                                      &d = grid.at(i, j + 1);
                    area += ((c.u - a.u) * (d.v - b.v) - (d.u - b.u) * (c.v - a.v)) / 2;
                }
        return area;
    }

  private:
    void add(const ShadingGrid& grid) {
        DicedGrid& diced = grids.emplace_back(DicedGrid{grid.shape, {}});
        for (size_t i = 0; i < grid.vertex_count(); ++i) {
            const int column = static_cast<int>(i) % grid.shape.vertices_u(),
                      row = static_cast<int>(i) / grid.shape.vertices_u();
            const bool is_border = column == 0 || column == grid.shape.nu || row == 0 || row == grid.shape.nv;
            diced.vertices.push_back({V3d(grid.P[0].at(i)), V3d(grid.N.at(i)), V3d(grid.Ng.at(i)),
                                      V3d(grid.dPdu.at(i)), V3d(grid.dPdv.at(i)), grid.u[i], grid.v[i],
                                      grid.s[i], grid.t[i], is_border});
        }
    }
};

/// A place and an orientation: the RIB that asks for them, and what they are.
struct Placement {
    const char* name;
    M44d camera_from_object;
    std::string orientation;  ///< requests
    int outside = 1;          ///< -1: normals point to the inside

    std::string text() const {
        std::string matrix = "ConcatTransform [";
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) matrix += std::to_string(camera_from_object[i][j]) + " ";
        return matrix + "] " + orientation + " ";
    }
};

/// Entries are short decimals: the text is the matrix.
inline std::vector<Placement> placements() {
    const M44d plain(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.25, -0.5, 20, 1);
    const M44d skewed(0.75, 0.5, 0, 0, -0.25, 1.25, 0.5, 0, 0.5, 0, 0.875, 0, 0.5, 0.25, 30, 1);
    M44d mirrored = skewed;
    for (int j = 0; j < 3; ++j) mirrored[1][j] = -mirrored[1][j];
    return {{"plain", plain, "", 1},
            {"skewed", skewed, "", 1},
            {"mirrored", mirrored, "", 1},
            {"inside", plain, "Orientation \"inside\"", -1},
            {"mirrored inside", mirrored, "Orientation \"inside\"", -1},
            {"left-handed", skewed, "Orientation \"lh\"", 1},
            {"right-handed", skewed, "Orientation \"rh\"", -1},
            {"mirrored left-handed", mirrored, "Orientation \"lh\"", -1},
            {"mirrored right-handed", mirrored, "Orientation \"rh\"", 1},
            {"reversed", skewed, "ReverseOrientation", -1},
            {"mirrored, reversed", mirrored, "ReverseOrientation", -1},
            {"reversed inside", plain, "Orientation \"inside\" ReverseOrientation", 1}};
}

inline V3d in_camera_space(const Placement& placement, const V3d& p) {
    V3d out;
    placement.camera_from_object.multVecMatrix(p, out);
    return out;
}

/// Positions and derivatives of a closed form, camera space.
struct FormPoint {
    V3d P, dPdu, dPdv, normal;  ///< normal: oriented, unit length, or 0
    double area = 0;            ///< of dPdu x dPdv
};

/// Derivatives from central differences: good to 1e-9 of sizes of 1.
inline FormPoint form_point(const ClosedForm& form, const Placement& placement, double u, double v) {
    constexpr double h = 1.0 / (1 << 15);
    FormPoint p;
    const auto at = [&](double x, double y) { return in_camera_space(placement, form(x, y)); };
    p.P = at(u, v);
    p.dPdu = (at(u + h, v) - at(u - h, v)) / (2 * h);
    p.dPdv = (at(u, v + h) - at(u, v - h)) / (2 * h);
    const V3d n = p.dPdu.cross(p.dPdv);
    p.area = n.length();
    const double handed = placement.camera_from_object.determinant() < 0 ? -1 : 1;
    if (p.area > 0) p.normal = n * (placement.outside * handed / p.area);
    return p;
}

/// How near diced values have to come, and by which parameters.
struct Tolerance {
    double position = 1e-6;    ///< of the largest distance from the object's origin
    double derivative = 1e-5;  ///< of the largest derivative
    double normal = 1e-5;      ///< of 1; where the area is more than `regular` of the largest
    double regular = 0.02;
    bool by_st = false;                 ///< the form's parameters are s and t, not u and v
    Imath::V2d begin{0, 0}, end{1, 1};  ///< of the parameters
    double parameter_area() const { return (end.x - begin.x) * (end.y - begin.y); }
};

/// All vertices of the primitive in `text`, in a placement, are the form's: positions, normals, derivatives
/// and parameters. (A displacement that nobody runs keeps the parameters of moved border vertices with them;
/// without it only those within grids are compared.)
inline void expect_pieces(const std::string& text, const PiecewiseForm& piece_at, const Placement& placement,
                          const Tolerance& tolerance = {}, bool with_borders = true) {
    SCOPED_TRACE(text + " (" + placement.name + (with_borders ? ")" : ", without borders)"));
    DicedRib diced(placement.text() + (with_borders ? "Displacement \"none\" " : "") + text);
    EXPECT_THAT(diced.read.messages, ::testing::IsEmpty());
    ASSERT_GT(diced.vertex_count(), 0u);
    if (tolerance.by_st)
        for (DicedGrid& grid : diced.grids)
            for (DicedVertex& vertex : grid.vertices) vertex.u = vertex.s, vertex.v = vertex.t;
    EXPECT_NEAR(diced.parameter_area(), tolerance.parameter_area(), 1e-5 * tolerance.parameter_area());
    const V3d origin = in_camera_space(placement, V3d(0, 0, 0));
    double size = 0, by_u = 0, by_v = 0, area = 0;
    std::vector<std::pair<DicedVertex, FormPoint>> pairs;
    for (const DicedGrid& grid : diced.grids) {
        const Imath::V2d middle = grid.middle();
        const ClosedForm form = piece_at(middle.x, middle.y);
        for (const DicedVertex& vertex : grid.vertices) {
            const FormPoint p = form_point(form, placement, vertex.u, vertex.v);
            size = std::max(size, (p.P - origin).length()), area = std::max(area, p.area);
            by_u = std::max(by_u, p.dPdu.length()), by_v = std::max(by_v, p.dPdv.length());
            if (with_borders || !vertex.is_border) pairs.emplace_back(vertex, p);
        }
    }
    size += 1e-7 * origin.length() / tolerance.position;  // what adding the translation rounds away
    double off = 0, off_u = 0, off_v = 0, off_n = 0, off_ng = 0, off_unit = 0, off_st = 0;
    for (const auto& [vertex, p] : pairs) {
        off = std::max(off, (vertex.P - p.P).length());
        off_unit = std::max(off_unit, std::abs(vertex.N.length() - 1));
        if (!tolerance.by_st) {
            const Imath::V2d size_uv = tolerance.end - tolerance.begin;
            off_st = std::max({off_st, std::abs(vertex.s - (vertex.u - tolerance.begin.x) / size_uv.x),
                               std::abs(vertex.t - (vertex.v - tolerance.begin.y) / size_uv.y)});
        }
        if (p.area < tolerance.regular * area) continue;
        off_u = std::max(off_u, (vertex.dPdu - p.dPdu).length());
        off_v = std::max(off_v, (vertex.dPdv - p.dPdv).length());
        off_n = std::max(off_n, (vertex.N - p.normal).length());
        off_ng = std::max(off_ng, (vertex.Ng - p.normal).length());
    }
    EXPECT_LE(off, tolerance.position * size);
    EXPECT_LE(off_u, tolerance.derivative * by_u);
    EXPECT_LE(off_v, tolerance.derivative * by_v);
    EXPECT_LE(off_n, tolerance.normal);
    EXPECT_LE(off_ng, tolerance.normal);
    EXPECT_LE(off_unit, 1e-5);
    EXPECT_LE(off_st, 2.5e-7);  // bilinear in the default corners
}

inline void expect_form(const std::string& text, const ClosedForm& form, const Placement& placement,
                        const Tolerance& tolerance = {}, bool with_borders = true) {
    expect_pieces(
        text, [&](double, double) { return form; }, placement, tolerance, with_borders);
}

/// In every placement, borders and all; and once without what keeps borders and parameters together.
inline void expect_form_everywhere(const std::string& text, const ClosedForm& form,
                                   const Tolerance& tolerance = {}) {
    for (const Placement& placement : placements()) expect_form(text, form, placement, tolerance);
    expect_form(text, form, placements()[1], tolerance, false);
}

/// Rays from inside the surface that the text makes (camera space) all leave through it.
inline void expect_no_leaks(const std::string& text, const std::function<V3f(uint32_t)>& inside,
                            int64_t rays = 100'000) {
    SCOPED_TRACE(text);
    ReadOutcome read = read_text(
        "Format 96 72 1 Projection \"perspective\" \"fov\" 90 Clipping 0.001 1000\nWorldBegin "
        "Attribute \"displacementbound\" \"sphere\" 1e4 " +
        text + "\nWorldEnd");
    ASSERT_EQ(read.count(), 1u);
    TestScene scene;
    scene.scene = std::move(read.worlds[0]);
    const LeakCount count = count_leaks(
        scene, [&](uint32_t n, float) { return inside(n); }, rays);
    EXPECT_EQ(count.leaks, 0);
    EXPECT_EQ(count.wrong_sides, 0);
    EXPECT_EQ(count.open_sides, 0u);
    EXPECT_GE(count.hits, count.rays);
}

}  // namespace trapeze::testing
