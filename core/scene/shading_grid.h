/// A grid on its way from the dicer through the shaders: structure of arrays, row by row, u fastest,
/// shape.vertex_count() values each. Camera space at shutter open unless said. One per thread, reused:
/// clear() keeps memory.
#pragma once

#include <array>
#include <compare>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/grid.h"
#include "core/ray_footprint.h"
#include "core/scene/parameters.h"
#include "core/scene/vertex_set.h"

namespace trapeze {

class MotionTurn;
struct Primitive;
struct Scene;
struct Shape;

/// Three planes of floats: points, vectors, normals or colours.
struct Triples {
    std::array<std::vector<float>, 3> c;

    void resize(size_t n) {
        for (auto& plane : c) plane.resize(n);
    }
    void fill(size_t n, const V3f& value) {
        for (int k = 0; k < 3; ++k) c[k].assign(n, value[k]);
    }
    V3f at(size_t i) const { return {c[0][i], c[1][i], c[2][i]}; }
    void set(size_t i, const V3f& v) {
        for (int k = 0; k < 3; ++k) c[k][i] = v[k];
    }
    size_t size() const { return c[0].size(); }
};

/// A primitive variable diced on the grid: planes of `vertex_count` floats, or one value when uniform over
/// the grid.
struct GridVariable {
    std::string name;
    Declaration declaration;
    bool uniform = false;                    ///< one value for the whole grid
    std::vector<std::vector<float>> planes;  ///< declaration.floats_per_item() planes
    std::vector<std::string> strings;        ///< strings are always uniform
};

/// A value that comes along with a ray and stands in place of a parameter of shaders that run where it hits.
struct SentVariable {
    HitShader to = HitShader::Surface;
    GridVariable variable;  ///< uniform
    SourceLocation at;      ///< of what sends it
};

/// What a ray goes through between two surfaces: the inside of the one that it has left, or what is outside.
struct RayMedium {
    static constexpr uint32_t kNone = ~uint32_t{0};
    uint32_t primitive = kNone;  ///< in Scene::primitives: the one that was left
    bool inside = false;         ///< its Interior shader counts, else its Exterior
    auto operator<=>(const RayMedium&) const = default;
};

/// What shaders read and make of a grid.
struct ShadingGrid {
    GridShape shape;
    int pieces = 1;  ///< how many grids of `shape` follow each other in each plane; 1 except in a border
    int key_count = 1;
    /// Which of its sides lie on the sides of its face, where another surface may stand: a bit each.
    uint8_t face_sides = 0;
    static constexpr uint8_t kFirstU = 1, kLastU = 2, kFirstV = 4, kLastV = 8, kAllSides = 15;
    const Primitive* primitive = nullptr;
    uint32_t primitive_index = 0;
    uint64_t ordinal = 0;  ///< place in the order of the frame's grids
    uint64_t seed = 0;     ///< of random numbers: of its place on its primitive, or of the ray that hit
    bool reverse_orientation = false;  ///< dPdu x dPdv points inside
    /// The vertices whose colours are wanted; null: all. Others need no rays: see
    /// Shading::may_ask_for_some().
    const VertexSet* wanted = nullptr;

    std::vector<Triples>
        P;       ///< position at each key; shaders see and displace P[0], which is moved into all keys
    Triples N;   ///< unit shading normal: primitive variable "N", or the surface's own; oriented outside
    Triples Ng;  ///< unit normal of the surface, dPdu x dPdv, oriented outside
    /// From where the points are seen, to P: of what a ray has hit, as see_hit() has it. Without values they
    /// are seen by the camera.
    Triples I;
    int hit_vertex = -1;    ///< of what a ray has hit: the vertex there; only this one traces rays in turn
    float hit_time = 0;     ///< of what a ray has hit: when; its own rays go at that time, too
    uint8_t hit_level = 0;  ///< of what a ray has hit: RaySurfaceHit::level
    /// Of what a ray has hit, where shaders displace it first: the place on the micropolygon, at hit_time.
    std::optional<V3f> hit_place;
    V3f hit_from{0, 0, 0};  ///< of what a ray has hit: from where it is seen, then
    RayFootprint hit_ray;   ///< of what a ray has hit: of the ray, there and then
    /// Of hit_ray: from there to where the rays beside it are, turned back as I is.
    std::array<V3f, 2> hit_across{V3f(0, 0, 0), V3f(0, 0, 0)};
    RayMedium medium;         ///< of what a ray has hit: what it is seen through, if that has a shader
    bool own_colors = false;  ///< of what a ray has hit: stands for the primitive's own Cs and Os
    bool is_end = false;      ///< where a ray ends that has hit nothing there: the medium's shader runs alone
    bool for_opacity = false;  ///< of what a ray has hit: Oi is wanted alone
    Triples dPdu,
        dPdv;  ///< derivatives by the surface's u and v, which run 0..1 over the primitive's face or patch
    std::vector<float> u, v;  ///< surface parameters
    std::vector<float> s, t;  ///< texture coordinates
    Triples Cs, Os;           ///< surface colour and opacity
    std::vector<GridVariable>
        variables;  ///< other primitive variables, transformed to camera space where they are geometry

    Triples Ci, Oi;          ///< what shading makes
    bool displaced = false;  ///< a displacement shader has moved P

    /// For displacement: what the vertices on the grid's border share with neighbouring grids. Pieces of 2x2
    /// vertices, of which the values depend on the shared point alone; one of each piece's vertices is the
    /// border vertex itself. A grid of pieces for each face of the surface that they lie on.
    std::vector<ShadingGrid> border;
    struct SharedVertex {
        int vertex = 0;     ///< of this grid
        int in_border = 0;  ///< counted through the vertices of all of border
    };
    std::vector<SharedVertex> shared_vertices;

    /// What Displays ask for besides: a plane of vertex_count() floats for each channel of aov_layout(), or
    /// none at all.
    std::vector<std::vector<float>> aovs;

    /// Of what a ray has hit: what came along with the ray; of one name the last counts.
    std::vector<SentVariable> sent;
    /// Of what a ray has hit: what was asked of the vertex there, besides its colour
    /// (shade/rays/hit_outputs.h).
    std::vector<float> answers;

    size_t vertex_count() const { return static_cast<size_t>(shape.vertex_count()) * pieces; }
    /// The variable of a name, or null; P, N, s, t and the others above are not among them.
    const GridVariable* find(std::string_view name) const {
        for (const GridVariable& variable : variables)
            if (variable.name == name) return &variable;
        return nullptr;
    }
};

/// Where a vertex is at a time, 0 at shutter open.
V3f place_at(const ShadingGrid& grid, size_t vertex, float time01);
/// Moves the grid of a hit, all of it and at all times, until the vertex that was hit is at `place` at its
/// time.
void move_hit_to(const V3f& place, ShadingGrid& grid);

/// Sets I of a hit's grid, and hit_across. I is the way at the hit's time, turned back to how the surface
/// lies at shutter open: from hit_from, and of other vertices from where the ray that would meet them comes
/// by there, as far as the rays beside the hit's tell.
void see_hit(ShadingGrid& grid);

/// How a grid's surface turns as its own rays have it. `held`: Scene::held_from_camera; a hit needs none, for
/// what rays meet has no motion of the camera in it.
MotionTurn turn_of(const ShadingGrid& grid, std::span<const M44f> held);
/// The keys of that motion; of 1 key nothing moves.
int motion_keys_of(const ShadingGrid& grid, std::span<const M44f> held);

/// Which side of the grid's micropolygons can be hit, for Sides: which sign of projected area shows the
/// outside. See grid winding in hit_micropolygon.h: with rays along +z, dPdu x dPdv points to the viewer
/// (negative z) when the area is negative.
Facing facing_for_sides(int sides, bool reverse_orientation);

/// How pack_grid() departs from what the grid's attributes say.
struct PackOptions {
    bool keep_hits_behind = false;  ///< the grid does not count as opaque, whatever Oi
    bool both_sides = false;        ///< hit from both, whatever Sides
    bool float_colors = false;      ///< colours are kept as floats, not as halves
};

/// Whether the primitive's surface turns to the viewer, as points do and curves without normals: it then has
/// no back.
bool faces_the_eye(const Shape& shape);

/// What a scene asks of a primitive's grids, but for float_colors. Hits behind a grid are kept where samples
/// may not see what they hit there: it may be cut away, or be of another level of detail than theirs; and
/// where the depth of the second layer is wanted. What may be cut away shows its inside; points, and curves
/// without normals, have no back.
PackOptions pack_options(const Scene& scene, const Primitive& primitive);

/// Packs a shaded grid: positions into tiles, Ci and Oi into halves or floats, output variables into floats.
/// Values that are not finite become 0 (colours and output variables) or the nearest finite vertex's
/// position; *not_finite counts them. Halves, and opacities, are clamped to the finite halves, other floats
/// to +-kInfinity, so that sums of them are finite.
Grid pack_grid(const ShadingGrid& shading, GridArena& arena, int64_t* not_finite,
               const PackOptions& options = {});

}  // namespace trapeze
