#include "shade/clouds/point_based_call.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/portable_math.h"
#include "shade/rays/ray_directions.h"
#include "shade/rays/sky_in.h"

namespace trapeze {
namespace {

using rsl::Op;
using vm::Operand;
using vm::Run;
using vm::Step;

/// How far vertices at a grid's edge look from, of the way to the vertex beside them.
constexpr float kAside = 0.25f;

/// From a vertex towards the inside of its grid, where it is at the grid's edge: from within the plane of a
/// wall that stands there nothing is seen of the wall. What a ray has hit is not at an edge.
V3f aside_of(const vm::GridSpan& span, size_t vertex) {
    const int nu = span.shape.nu, nv = span.shape.nv;
    if (!span.grid || span.hit_vertex >= 0 || span.grid->P.empty()) return V3f(0);
    const int i = static_cast<int>(vertex) % (nu + 1), j = static_cast<int>(vertex) / (nu + 1);
    const auto inwards = [](int at, int end) { return end == 0 ? 0 : at == 0 ? 1 : at == end ? -1 : 0; };
    const int beside = (j + inwards(j, nv)) * (nu + 1) + i + inwards(i, nu);
    const Triples& P = span.grid->P.front();
    const V3f way = (P.at(static_cast<size_t>(beside)) - P.at(vertex)) * kAside;
    return std::isfinite(way.length2()) ? way : V3f(0);
}

}  // namespace

PointBasedCall::PointBasedCall(Run& run, const Step& step, std::span<const Operand> operands,
                               CloudLibrary* library, SceneSurfels* scene, bool of_discs)
    : run_(run), step_(step), operands_(operands), arguments_(run, step, operands) {
    if (arguments_.point_based.at(0) == 0 || !library || !run.context().batch) return;
    tree_ = arguments_.cloud.empty() ? find_scene(scene, of_discs) : find_cloud(*library);
    // What is made of the scene is in the current space.
    if (tree_ && !arguments_.cloud.empty() && !set_space()) tree_ = nullptr;
    if (tree_ && arguments_.sets("hitdist"))
        run.warn(step, "\"hitdist\" is not known of point clouds: it is 1e30", "pointbased hitdist");
}

/// Says why there is no cloud.
const SurfelTree* PointBasedCall::use_rays(const std::string& why) const {
    const char* const call = step_.op == Op::IndirectDiffuse ? "indirectdiffuse" : "occlusion";
    run_.warn(step_, fmt::format("{}: {}; rays are sent instead", call, why),
              fmt::format("pointbased {} {}", call, arguments_.cloud));
    return nullptr;
}

/// The scene's discs; null where rays are to be sent. The colours of discs are made without those of others:
/// light bounces once.
const SurfelTree* PointBasedCall::find_scene(SceneSurfels* scene, bool of_discs) const {
    const bool light = step_.op == Op::IndirectDiffuse;
    if (!scene || !scene->has_scene() || (light && of_discs)) return nullptr;
    std::string problem;
    const SurfelTree* const tree = light ? scene->find_colored(&problem) : scene->find(&problem);
    return tree || problem.empty() ? tree : use_rays("the scene as discs: " + problem);
}

/// The discs of the file that the call names; null where rays are to be sent.
const SurfelTree* PointBasedCall::find_cloud(CloudLibrary& library) const {
    const bool light = step_.op == Op::IndirectDiffuse;
    const std::string& name = arguments_.cloud;
    std::string problem;
    const SurfelTree* const tree = library.surfels(name, &problem);
    if (!tree) return use_rays(fmt::format("point cloud \"{}\" cannot be read: {}", name, problem));
    if (tree->empty()) return use_rays(fmt::format("point cloud \"{}\" has no areas", name));
    if (light && !tree->has_radiosities())
        return use_rays(fmt::format("point cloud \"{}\" has no channel color \"_radiosity\"", name));
    return tree;
}

bool PointBasedCall::set_space() {
    if (!run_.context().spaces || arguments_.cloud_space == "current") return true;
    const auto to = run_.context().spaces->matrix("current", arguments_.cloud_space);
    const double volume = to ? std::abs(M44d(*to).determinant()) : 0;
    if (!(volume > 0) || !std::isfinite(volume)) {
        run_.warn(step_,
                  fmt::format("\"pointbased\": there is no coordinate system \"{}\"; rays are sent instead",
                              arguments_.cloud_space),
                  "pointbased-space " + arguments_.cloud_space);
        return false;
    }
    moved_ = true;
    const M44d exact(*to);
    to_space_ = *to, from_space_ = M44f(exact.inverse());
    normals_to_space_ = M44f(exact.inverse().transposed());
    scale_ = static_cast<float>(portable::pow(volume, 1.0 / 3));
    return true;
}

/// Only the first lane is told anything where all results are uniform.
void PointBasedCall::run(PointBasedScratch& scratch) const {
    const bool uniform = std::ranges::none_of(operands_.first(step_.outputs),
                                              [](const Operand& out) { return out.lane_mask != 0; });
    set_unwanted_lanes(run_, operands_.first(step_.outputs));
    for_each_asking_lane(run_, uniform,
                         [&](const vm::GridSpan& span, size_t vertex, const AskingLane& asking) {
                             look(asking.lane, aside_of(span, vertex), scratch);
                             put(asking, scratch.raster, sky_over(asking.lane, scratch));
                         });
}

/// Lanes mostly ask for the same part of the sky.
const SkyPart& PointBasedCall::sky_of(size_t lane) const {
    const float angle = arguments_.cone_angle_at(lane);
    if (!sky_ || angle != sky_angle_) sky_.emplace(angle, arguments_.uniform_distribution);
    sky_angle_ = angle;
    return *sky_;
}

/// Fills the raster with what a lane sees from beside its point.
void PointBasedCall::look(size_t lane, const V3f& aside, PointBasedScratch& scratch) const {
    SurfelPlace place;
    place.position = arguments_.from_at(lane) + aside, place.normal = arguments_.towards_at(lane);
    if (moved_) {
        to_space_.multVecMatrix(V3f(place.position), place.position);
        normals_to_space_.multDirMatrix(V3f(place.normal), place.normal);
    }
    place.normal.normalize();
    const bool looks = std::isfinite(place.position.length2()) && place.normal.length2() > 0;
    scratch.raster.start(looks ? place.normal : V3f(0, 0, 1), sky_of(lane), arguments_.clamp.at(lane) != 0);
    if (!looks) return;
    place.max_solid_angle = arguments_.max_solid_angle.at(lane);
    place.max_distance = arguments_.max_distance_at(lane) * scale_;
    place.bias = arguments_.bias.at(lane) * scale_;
    tree_->cut(place, scratch.pieces);
    // What is hidden does not depend on the order where all counts alike and hides all behind it.
    if (step_.op == Op::IndirectDiffuse || arguments_.falloff.operand || tree_->is_seen_through())
        std::ranges::sort(scratch.pieces, [](const SurfelPiece& a, const SurfelPiece& b) {
            if (a.distance != b.distance) return a.distance < b.distance;
            return a.is_cluster != b.is_cluster ? b.is_cluster : a.number < b.number;
        });
    for (const SurfelPiece& piece : scratch.pieces) add(piece, place, lane, scratch.raster);
}

void PointBasedCall::add(const SurfelPiece& piece, const SurfelPlace& place, size_t lane,
                         SurfelRaster& raster) const {
    using Sides = RayFilter::Sides;
    const Sides sides = arguments_.sides();
    SeenSurface seen;
    const float distance2 = piece.distance * piece.distance;
    if (sides != Sides::Back) seen.front = piece.front / distance2;
    if (sides != Sides::Front) seen.back = piece.back / distance2;
    if (!(seen.front > 0) && !(seen.back > 0)) return;
    seen.opacity = piece.opacity;
    seen.counts = arguments_.falloff_at(piece.distance / scale_, lane);
    if (step_.op == Op::IndirectDiffuse) seen.color = tree_->radiosity(piece) * seen.counts;
    if (piece.is_large && !tree_->surfels().quads.empty())
        raster.add_quad(tree_->quad_from(place.position, piece.number), tree_->disc_area(piece.number), seen);
    else if (piece.is_large)
        raster.add_disc(piece.way, tree_->surfels().normals[piece.number], tree_->disc_radius(piece.number),
                        seen);
    else
        raster.add_small(piece.way / piece.distance, seen);
}

/// What comes from behind everything ("environmentmap"), where no disc is.
V3f PointBasedCall::sky_over(size_t lane, PointBasedScratch& scratch) const {
    V3f sum(0);
    if (arguments_.environment_map.empty()) return sum;
    scratch.raster.open_parts(scratch.ways, scratch.parts);
    for (V3f& way : scratch.ways) {
        if (moved_) from_space_.multDirMatrix(V3f(way), way);
        way.normalize();
    }
    const float width = spread_of(arguments_.cone_angle_at(lane), sky_of(lane).pixels_seen());
    const std::vector<V3f> colors = sky_in(run_, step_, arguments_.environment_map,
                                           arguments_.environment_space, scratch.ways, std::array{width});
    for (size_t i = 0; i < colors.size(); ++i) sum += colors[i] * scratch.parts[i];
    return sum;
}

void PointBasedCall::put(const AskingLane& lanes, const SurfelRaster& raster, const V3f& sky) const {
    const float hidden = std::min(1.0f, raster.hidden());
    put_lanes(operands_[0], lanes.first, lanes.count,
              step_.op == Op::IndirectDiffuse ? raster.light() + sky : V3f(hidden));
    for (const RayArguments::Output& output : arguments_.outputs) {
        if (output.name == "occlusion") put_lanes(*output.operand, lanes.first, lanes.count, V3f(hidden));
        if (output.name == "environmentcolor") put_lanes(*output.operand, lanes.first, lanes.count, sky);
        if (output.name == "hitdist")  // discs hide parts of the sky together: no way is hit by one
            put_lanes(*output.operand, lanes.first, lanes.count, V3f(kInfinity));
        if (output.name != "environmentdir") continue;
        V3f way = raster.open_way();
        if (moved_) from_space_.multDirMatrix(V3f(way), way);
        put_lanes(*output.operand, lanes.first, lanes.count, way.normalized());
    }
}

}  // namespace trapeze
