#include "shade/clouds/scene_surfels.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <tuple>
#include <utility>
#include <vector>

#include "core/random.h"

namespace trapeze {
namespace {

constexpr size_t kShadedTogether = 128;  ///< discs
/// Calls of the discs' shaders send no diffuse rays: what discs send comes from lights alone.
constexpr int kBounces = 1;

const char* const kTooLarge = "there is not enough memory for its discs (a quarter of --memory)";

HitVisit visit_of_discs() {
    HitVisit visit;
    visit.kind = RayKind::Diffuse;
    visit.depths.bounces[static_cast<size_t>(RayKind::Diffuse)] = kBounces;
    visit.depths.most[static_cast<size_t>(RayKind::Diffuse)] = kBounces;
    return visit;
}

/// Sets up a grid of one micropolygon to be shaded as it is seen along a disc's normal, from one side, so
/// near that nothing lies between.
void look_at(ShadingGrid& grid, int vertex, const V3f& normal, float distance, uint64_t id, bool back) {
    const V3f way = normal * (back ? distance : -distance);
    const V3f eye = grid.P.front().at(static_cast<size_t>(vertex)) - way;
    grid.I.resize(grid.vertex_count());
    for (size_t i = 0; i < grid.vertex_count(); ++i) grid.I.set(i, grid.P.front().at(i) - eye);
    grid.hit_vertex = vertex, grid.hit_time = 0, grid.hit_level = 0;
    grid.medium = RayMedium(), grid.for_opacity = false, grid.hit_ray = RayFootprint();
    const RayAttributes& rays = grid.primitive->attributes->rays;
    grid.own_colors = rays.diffuse_hits == RayAttributes::HitMode::Primitive;
    const auto low = static_cast<uint32_t>(id), high = static_cast<uint32_t>(id >> 32);
    grid.seed = uint64_t{hash(low, high, 5, back)} << 32 | hash(low, high, 6, back);
    grid.answers.clear();
    grid.Ci.fill(grid.vertex_count(), V3f(0));  // of a frame that is cancelled
}

/// What a disc sends, of which the area is smaller where light shines through.
V3f sent_by(const ShadingGrid& grid) {
    const auto at = static_cast<size_t>(grid.hit_vertex);
    const V3f opacity = grid.Os.at(at), color = grid.Ci.at(at);
    const float part = std::clamp((opacity.x + opacity.y + opacity.z) / 3, 0.0f, 1.0f);
    return part > 0 ? color / part : V3f(0);
}

}  // namespace

/// The discs being shaded, some at a time, by all who come by.
struct SceneSurfels::Coloring {
    std::vector<V3f> fronts, backs;
    std::atomic<size_t> next{0};
    std::mutex mutex;
    std::condition_variable changed;
    size_t finished = 0;  ///< discs
    bool done = false;    ///< the tree has them

    /// Some discs, which count as finished also where their shaders have thrown: others wait for them.
    struct Finish {
        Coloring& of;
        size_t discs;
        ~Finish() {
            const std::lock_guard lock(of.mutex);
            of.finished += discs;
            of.changed.notify_all();
        }
    };
};

SceneSurfels::SceneSurfels(CloudLibrary& library) : library_(library) {}
SceneSurfels::~SceneSurfels() = default;

void SceneSurfels::set_scene(const RayScene* scene, MakeSurfelShader make_shader) {
    scene_ = scene, make_shader_ = std::move(make_shader);
}

void SceneSurfels::forget_colors() {
    coloring_.reset();
}

const SurfelTree* SceneSurfels::find(std::string* problem) {
    const std::lock_guard lock(tree_mutex_);
    if (!tree_ && tree_problem_.empty()) {
        const std::optional<Surfels> discs = scene_->surfels(RayKind::Diffuse, library_.bytes_left());
        auto tree = discs ? std::make_unique<SurfelTree>(*discs) : nullptr;
        if (tree && library_.reserve(tree->bytes()))
            tree_ = std::move(tree);
        else
            tree_problem_ = kTooLarge;
    }
    *problem = tree_problem_;
    return tree_.get();
}

const SurfelTree* SceneSurfels::find_colored(std::string* problem) {
    if (!find(problem)) return nullptr;
    std::shared_ptr<Coloring> coloring;
    bool first = false;
    {
        const std::lock_guard lock(color_mutex_);
        if (!coloring_ && color_problem_.empty()) {
            first = true;
            if (tree_->has_radiosities() || library_.reserve(tree_->bytes_of_radiosities())) {
                coloring_ = std::make_shared<Coloring>();
                coloring_->fronts.resize(tree_->surfels().size());
                coloring_->backs.resize(tree_->surfels().size());
            } else {
                color_problem_ = kTooLarge;
            }
        }
        coloring = coloring_;
        *problem = color_problem_;
    }
    if (!coloring) return nullptr;
    if (first) scene_->in_parallel([&] { take_colors(*coloring); });
    take_colors(*coloring);
    std::unique_lock lock(coloring->mutex);
    const size_t all = tree_->surfels().size();
    coloring->changed.wait(lock, [&] { return coloring->done || (first && coloring->finished == all); });
    if (!coloring->done) {
        tree_->set_radiosities(std::move(coloring->fronts), std::move(coloring->backs));
        coloring->done = true;
        coloring->changed.notify_all();
    }
    return tree_.get();
}

/// Shades discs until others have taken the last ones. Discs of one primitive are shaded side by side.
void SceneSurfels::take_colors(Coloring& coloring) {
    const Surfels& discs = tree_->surfels();
    ShadeSurfels shade;
    std::deque<ShadingGrid> grids;
    std::vector<ShadingGrid*> shaded;
    const HitVisit visit = visit_of_discs();
    for (;;) {
        const size_t begin = coloring.next.fetch_add(kShadedTogether);
        const size_t end = std::min(begin + kShadedTogether, discs.size());
        if (begin >= end) return;
        const Coloring::Finish finish{coloring, end - begin};
        if (!shade) shade = make_shader_();
        grids.resize(2 * kShadedTogether), shaded.clear();
        for (size_t i = begin; i < end; ++i)
            for (const bool back : {false, true}) {
                ShadingGrid& grid = grids[2 * (i - begin) + back];
                const int vertex = scene_->dice_surfel(discs.ids[i], grid);
                look_at(grid, vertex, discs.normals[i], scene_->spacing(discs.positions[i]), discs.ids[i],
                        back);
                shaded.push_back(&grid);
            }
        std::ranges::stable_sort(shaded, {}, [](const ShadingGrid* grid) {
            return std::tuple(grid->primitive_index, grid->own_colors);
        });
        shade(shaded, visit);
        for (size_t i = begin; i < end; ++i) {
            coloring.fronts[i] = sent_by(grids[2 * (i - begin)]);
            coloring.backs[i] = sent_by(grids[2 * (i - begin) + 1]);
        }
    }
}

}  // namespace trapeze
