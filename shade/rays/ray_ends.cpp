/// Where rays end without having met anything: what they come there through dims what arrives.
#include <algorithm>

#include "core/axes_around.h"
#include "shade/rays/inside_search.h"
#include "shade/rays/ray_walk.h"

namespace trapeze {
namespace {

/// Ends that are shaded together.
constexpr size_t kEndsTogether = 256;

/// A micropolygon of this side that faces the ray, of nothing, the first vertex at the end.
void make_end(const V3f& end, const V3f& direction, float side, ShadingGrid& grid) {
    const AxesAround<float> facing(-direction);
    grid.shape = GridShape{1, 1};
    const size_t count = grid.vertex_count();
    grid.face_sides = 0, grid.key_count = 1, grid.reverse_orientation = false;
    grid.displaced = false;
    grid.border.clear(), grid.shared_vertices.clear(), grid.variables.clear();
    grid.P.resize(1), grid.P.front().resize(count);
    for (std::vector<float>* values : {&grid.u, &grid.v, &grid.s, &grid.t}) values->resize(count);
    for (int v = 0; v <= 1; ++v)
        for (int u = 0; u <= 1; ++u) {
            const auto i = static_cast<size_t>(grid.shape.row_index(u, v));
            const float fu = static_cast<float>(u), fv = static_cast<float>(v);
            grid.P.front().set(i, end + (facing.across * fu + facing.along * fv) * side);
            grid.u[i] = grid.s[i] = fu, grid.v[i] = grid.t[i] = fv;
        }
    grid.N.fill(count, facing.axis), grid.Ng.fill(count, facing.axis);
    grid.dPdu.fill(count, facing.across * side), grid.dPdv.fill(count, facing.along * side);
    grid.Cs.fill(count, V3f(1, 1, 1)), grid.Os.fill(count, V3f(0, 0, 0));
    grid.Ci.resize(count), grid.Oi.resize(count);
    grid.hit_vertex = 0, grid.hit_place.reset();
    grid.own_colors = grid.is_end = true;
}

/// From where on what has not counted may be met: as it may lie on the end.
float end_of_sure(const RaySegment& segment) {
    return std::max(segment.min, std::min(segment.max, segment.reached.sure()));
}

}  // namespace

/// Whether media count at the end of a ray that meets nothing there. What has no end is seen through nothing,
/// and where a gather misses it is not asked what is seen.
bool RayWalk::ends_in_media(const WalkedRay& ray, const RayAsk& ask) const {
    return !volumes_.empty() && ask.shades && !ask.first_alone && (!ask.outputs || ray.hits()) &&
           ray.end < kInfinity && ray.end > ray.medium_from;
}

/// The grid of a ray's end, seen from where its medium begins.
ShadingGrid& RayWalk::grid_at_end(const WalkedRay& ray, const RayAsk& ask, size_t number) {
    ShadingGrid& grid = grid_of_number(number);
    const RaySegment& segment = ray.segment;
    const V3f end = segment.origin + segment.direction * ray.end;
    make_end(end, segment.direction, scene_.spacing(end), grid);
    grid.medium = volumes_.has(ray.medium) ? ray.medium : ray.end_medium;
    grid.primitive_index = grid.medium.primitive;
    grid.primitive = &volumes_.primitive(grid.primitive_index);
    grid.hit_time = segment.time, grid.hit_level = segment.level;
    grid.hit_from = segment.origin + segment.direction * ray.medium_from;
    grid.hit_ray = ray.footprint.behind(ray.end);
    see_hit(grid);
    grid.seed = ray.seed;
    grid.answers.clear();
    send(ray, ask, grid);
    return grid;
}

/// Runs the shaders of what rays come to their ends through, as if a surface that cannot be seen were there.
Task<> RayWalk::come_to_ends(std::vector<WalkedRay*>& rays, const RayAsk& ask, Wants wants) {
    InsideSearch search(scene_, volumes_, ask.kind);
    for (WalkedRay* const ray : rays)
        if (volumes_.has_insides() && !volumes_.has(ray->medium) && !volumes_.has(ray->end_medium))
            search.add(ray->segment, end_of_sure(ray->segment), ray->end_medium);
    search.run();
    std::erase_if(rays, [&](const WalkedRay* ray) {
        return !volumes_.has(ray->medium) && !volumes_.has(ray->end_medium);
    });
    HitVisit visit;
    visit.kind = ask.kind, visit.label = ask.label, visit.depths = ask.depths;
    std::vector<ShadingGrid*> grids, sorted;
    for (size_t first = 0; first < rays.size(); first += kEndsTogether) {
        const auto some = std::span(rays).subspan(first, std::min(kEndsTogether, rays.size() - first));
        grids.clear();
        for (const WalkedRay* ray : some) {
            grids.push_back(&grid_at_end(*ray, ask, grids.size()));
            grids.back()->for_opacity = wants == Wants::Opacity;
        }
        stats_.shaded_hits += grids.size();
        sorted = grids;
        std::ranges::stable_sort(sorted, {}, &ShadingGrid::medium);
        co_await shade_(sorted, visit);
        for (size_t i = 0; i < some.size(); ++i) {
            const auto vertex = static_cast<size_t>(grids[i]->hit_vertex);
            see(*some[i], grids[i]->Ci.at(vertex), grids[i]->Oi.at(vertex));
        }
    }
}

}  // namespace trapeze
