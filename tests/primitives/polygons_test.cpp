/// The four polygon requests (RISpec 5.1): areas, planes, normals and default variables of what is diced,
/// from the loops alone.
#include "tests/primitives/blends_harness.h"
#include "tests/primitives/dice_rib_harness.h"

namespace trapeze::testing {
namespace {

using Loop = std::vector<V3d>;

/// In a plane that is none of the axes', and with short decimals.
V3d on_plane(double x, double y) {
    return {x, y, 0.5 * x - 0.25 * y + 0.125};
}

/// A star with an inlet, and two holes in it that turn the other way and the same way round.
const std::vector<Loop> kLoops = {
    {on_plane(-3, -2), on_plane(3, -2), on_plane(1.5, 0), on_plane(3, 2.5), on_plane(0, 1.25),
     on_plane(-3, 2.5), on_plane(-1.5, 0.25)},
    {on_plane(-0.5, -0.5), on_plane(-0.5, 0.5), on_plane(0.5, 0.5), on_plane(0.5, -0.5)},
    {on_plane(1, -1.5), on_plane(1.5, -1.5), on_plane(1.25, -1)}};

/// Half the sum of cross products: as long as the area, along the normal (Newell).
V3d area_vector(const Loop& loop, const Placement& placement) {
    V3d sum(0, 0, 0);
    const V3d origin = in_camera_space(placement, loop[0]);
    for (size_t i = 0; i < loop.size(); ++i)
        sum += (in_camera_space(placement, loop[i]) - origin)
                   .cross(in_camera_space(placement, loop[(i + 1) % loop.size()]) - origin);
    return sum / 2;
}

V3d diced_area(const DicedRib& diced) {
    V3d sum(0, 0, 0);
    for (const DicedGrid& grid : diced.grids)
        for (int j = 0; j < grid.shape.nv; ++j)
            for (int i = 0; i < grid.shape.nu; ++i)
                sum += (grid.at(i + 1, j + 1).P - grid.at(i, j).P)
                           .cross(grid.at(i, j + 1).P - grid.at(i + 1, j).P) /
                       2;
    return sum;
}

std::string points_text(const std::vector<Loop>& loops) {
    std::string text = "\"P\" [";
    for (const Loop& loop : loops)
        for (const V3d& p : loop) text += decimal(p.x) + decimal(p.y) + decimal(p.z);
    return text + "]";
}

/// The text draws the outline without the holes, once, in its plane, and the outside is where RISpec says.
void expect_polygon(const std::string& text, const std::vector<Loop>& loops) {
    for (const Placement& placement : placements()) {
        SCOPED_TRACE(text + " (" + placement.name + ")");
        const DicedRib diced(placement.text() + text);
        EXPECT_THAT(diced.read.messages, ::testing::IsEmpty());
        V3d area = area_vector(loops[0], placement);
        for (size_t i = 1; i < loops.size(); ++i) {
            const V3d hole = area_vector(loops[i], placement);
            area -= hole.dot(area) > 0 ? hole : -hole;
        }
        EXPECT_LE((diced_area(diced) - area).length(), 2e-6 * area.length());
        const double handed = placement.camera_from_object.determinant() < 0 ? -1 : 1;
        const V3d normal = area.normalized() * placement.outside * handed;
        const V3d origin = in_camera_space(placement, loops[0][0]);
        const M44d to_object = placement.camera_from_object.inverse();
        double off_plane = 0, off_normal = 0, off_st = 0, off_uv = 0;
        for (const DicedGrid& grid : diced.grids)
            for (const DicedVertex& vertex : grid.vertices) {
                off_plane = std::max(off_plane, std::abs((vertex.P - origin).dot(normal)));
                off_normal = std::max({off_normal, (vertex.N - normal).length(),
                                       (vertex.Ng - normal).length(), (vertex.Ng - vertex.N).length()});
                off_uv = std::max({off_uv, std::abs(vertex.u - vertex.s), std::abs(vertex.v - vertex.t)});
                V3d p;
                to_object.multVecMatrix(vertex.P, p);
                // s and t are x and y, but of where the vertex was before it went to its edge's.
                if (!vertex.is_border)
                    off_st = std::max({off_st, std::abs(vertex.s - p.x), std::abs(vertex.t - p.y)});
            }
        EXPECT_LE(off_plane, 1e-5);
        EXPECT_LE(off_normal, 2e-5);
        EXPECT_LE(off_st, 2e-5);
        EXPECT_EQ(off_uv, 0);
    }
}

TEST(PolygonForms, ConvexOnes) {
    const Loop quad = {on_plane(-2, -1), on_plane(1, -2), on_plane(2, 1), on_plane(-1, 1.5)};
    Loop hexagon;
    for (int i = 0; i < 6; ++i)
        hexagon.push_back(on_plane(i < 3 ? i - 2 : 3 - i, i < 3 ? -1 - i % 2 : 1 + i % 2));
    expect_polygon("Polygon " + points_text({{quad[0], quad[1], quad[2]}}), {{quad[0], quad[1], quad[2]}});
    expect_polygon("Polygon " + points_text({quad}), {quad});
    expect_polygon("Polygon " + points_text({{quad.rbegin(), quad.rend()}}), {{quad.rbegin(), quad.rend()}});
    expect_polygon("Polygon " + points_text({hexagon}), {hexagon});
    expect_polygon("PointsPolygons [4] [3 2 1 0] " + points_text({quad}), {{quad.rbegin(), quad.rend()}});
}

TEST(PolygonForms, ConcaveOnesWithHoles) {
    expect_polygon("GeneralPolygon [7] " + points_text({kLoops[0]}), {kLoops[0]});
    expect_polygon("GeneralPolygon [7 4 3] " + points_text(kLoops), kLoops);
    expect_polygon(
        "PointsGeneralPolygons [3] [7 4 3] [0 1 2 3 4 5 6 7 8 9 10 11 12 13] " + points_text(kLoops), kLoops);
    // Backwards, the outline and one hole.
    expect_polygon("PointsGeneralPolygons [2] [7 3] [6 5 4 3 2 1 0 13 12 11] " + points_text(kLoops),
                   {{kLoops[0].rbegin(), kLoops[0].rend()}, {kLoops[2].rbegin(), kLoops[2].rend()}});
}

/// "s" alone, "t" alone and both, per vertex: what is not given is v or u, whatever TextureCoordinates say.
TEST(PolygonForms, TextureCoordinatesAreOwnOrThePlace) {
    const std::string points = "TextureCoordinates 5 5 6 5 5 6 6 6 Polygon \"P\" [0 1 0 2 1 0 2 4 0 0 4 0] ";
    for (const auto& [given, own_s, own_t] : {std::tuple("", false, false),
                                              {"\"s\" [7 7 7 7]", true, false},
                                              {"\"t\" [8 8 8 8]", false, true},
                                              {"\"st\" [7 8 7 8 7 8 7 8]", true, true}}) {
        const DicedRib diced(points + given);
        ASSERT_GT(diced.vertex_count(), 0u);
        for (const DicedGrid& grid : diced.grids)
            for (const DicedVertex& vertex : grid.vertices) {
                EXPECT_NEAR(vertex.s, own_s ? 7 : vertex.u, 1e-6) << given;
                EXPECT_NEAR(vertex.t, own_t ? 8 : vertex.v, 1e-6) << given;
            }
    }
}

/// Boxes of the mesh requests, each face with a hole's worth of other faces in it or none.
TEST(PolygonForms, ClosedOnesHaveNoHoles) {
    const auto inside = [](uint32_t n) {
        return V3f(0.2f, 0.1f, 1.3f) + random_direction(n, 3) * 0.7f * unit_float(hash(n, 4));
    };
    const std::string place = "Translate 0.2 0.1 1.3 Rotate 20 1 2 3 ";
    const std::string box = "\"P\" [-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1]";
    expect_no_leaks(
        place + "PointsPolygons [4 4 4 4 4 4] [0 2 3 1 4 5 7 6 0 1 5 4 2 6 7 3 0 4 6 2 1 3 7 5] " + box,
        inside);
    // A pane of the front closed by a hole's own polygon.
    expect_no_leaks(
        place +
            "PointsGeneralPolygons [2 1 1 1 1 1 1] [4 4 4 4 4 4 4 4] [0 2 3 1 8 9 10 11 8 11 10 9 4 5 "
            "7 6 0 1 5 4 2 6 7 3 0 4 6 2 1 3 7 5] " +
            box.substr(0, box.size() - 1) + " -0.5 -0.5 -1 0.25 -0.5 -1 0.25 0.5 -1 -0.5 0.5 -1]",
        inside);
    expect_no_leaks(place + "Geometry \"cube\"", [](uint32_t n) {
        return V3f(0.2f, 0.1f, 1.3f) + random_direction(n, 3) * 0.4f * unit_float(hash(n, 4));
    });
}

}  // namespace
}  // namespace trapeze::testing
