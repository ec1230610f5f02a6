#include "shade/grid_run.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/scene/light_groups.h"
#include "shade/answer_hits.h"
#include "shade/grid_footprints.h"
#include "shade/light_layers.h"
#include "shade/materials/grid_shader.h"
#include "shade/take_aovs.h"

namespace trapeze {
namespace {

/// Raises a maximum that several threads share.
void raise(std::atomic<float>& maximum, float value) {
    float seen = maximum.load(std::memory_order_relaxed);
    while (value > seen && !maximum.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {}
}

/// Whether one run may have both variables: each grid's vertices have its own, as the parameter `varies`, or
/// they are not uniform, or have the same values.
bool same_uniform(const GridVariable* a, const GridVariable* b, bool varies) {
    if (!a || !b) return a == b;
    if (a->uniform != b->uniform || a->strings != b->strings) return false;
    if (a->planes.size() != b->planes.size()) return false;
    if (!a->uniform || varies) return true;
    return std::ranges::equal(a->planes, b->planes, [](const auto& x, const auto& y) {
        return x.empty() == y.empty() &&
               (x.empty() || std::bit_cast<uint32_t>(x.front()) == std::bit_cast<uint32_t>(y.front()));
    });
}

bool same_uniforms(const LayeredShader* shader, const ShadingGrid& a, const ShadingGrid& b) {
    if (!shader) return true;
    for (const BoundShader* layer : shader->layers)
        for (const rsl::ProgramParameter& parameter : layer->program().parameters)
            if (!same_uniform(suitable_variable(a, layer->program(), parameter),
                              suitable_variable(b, layer->program(), parameter), layer->varies(parameter)))
                return false;
    return true;
}

/// What a grid is seen through: rays have `left` a surface that may say so, which the hit's own does not
/// know; else its atmosphere.
const LayeredShader* volume_before(const ShadingGrid& grid, const Material& material, const Material* left) {
    if (!left) return material.atmosphere;
    const bool inside = grid.medium.inside;
    const LayeredShader* const part = inside ? left->interior_opacity : left->exterior_opacity;
    if (grid.for_opacity && part) return part;
    return inside ? left->interior : left->exterior;
}

/// Takes from a list the grids that can share a run of the shader with its first.
std::vector<ShadingGrid*> take_run(std::vector<ShadingGrid*>& grids, const LayeredShader& shader) {
    const ShadingGrid& first = *grids.front();
    const auto rest = std::stable_partition(grids.begin(), grids.end(), [&](const ShadingGrid* grid) {
        return same_uniforms(&shader, first, *grid);
    });
    std::vector<ShadingGrid*> taken(grids.begin(), rest);
    grids.erase(grids.begin(), rest);
    return taken;
}

std::vector<BorderWeld> welds_of(std::span<ShadingGrid* const> grids) {
    std::vector<BorderWeld> welds;
    for (const ShadingGrid* grid : grids) welds.emplace_back(*grid);
    return welds;
}

std::vector<const ShadingGrid*> to_read(std::span<ShadingGrid* const> grids) {
    return {grids.begin(), grids.end()};
}

/// Of a hit that has been displaced: it is where its ray has met it, but where its surface shader `moves_on`,
/// and is seen there. I led to where it was before.
void see_displaced(bool moves_on, ShadingGrid& grid) {
    if (!grid.hit_place) return;
    if (!moves_on) move_hit_to(*grid.hit_place, grid);
    see_hit(grid);
}

}  // namespace

bool can_share_run(const Material& material, const Material* left, const ShadingGrid& a,
                   const ShadingGrid& b) {
    if (material.asks_primitive && a.primitive != b.primitive) return false;
    if (a.medium != b.medium || a.own_colors != b.own_colors || a.is_end != b.is_end) return false;
    return same_uniforms(material.displacement, a, b) && same_uniforms(material.surface, a, b) &&
           same_uniforms(volume_before(a, material, left), a, b);
}

GridRun::GridRun(const RenderContext& context, Textures& textures, const Material& material,
                 std::span<ShadingGrid* const> grids, GridRunScratch& scratch, const RayService* rays,
                 const CloudPlaces& clouds, const Material* left)
    : context_(context),
      material_(material),
      left_(left),
      grids_(grids),
      read_(to_read(grids)),
      scratch_(scratch),
      maps_(textures, *context.scene, context.seed),
      clouds_(clouds),
      messages_(context),
      batch_(batch_of(read_)) {
    messages_.attributes = material.attributes;
    messages_.primitive = grids.front()->primitive;
    if (rays) rays_.emplace(*rays, *material.attributes);
}

/// Displaces the grids, but leaves in their places what rays see undisplaced: it has the normals alone.
Task<GridRun::Layers> GridRun::displace_seen() {
    const bool stay = grids_.front()->hit_vertex >= 0 && !material_.attributes->rays.displaced;
    std::vector<std::vector<Triples>> places;
    for (const ShadingGrid* grid : grids_)
        if (stay) places.push_back(grid->P);
    Layers layers = co_await displace();
    for (size_t g = 0; g < places.size(); ++g) grids_[g]->P = std::move(places[g]);
    if (!stay)
        for (ShadingGrid* grid : grids_) see_displaced(material_.surface_moves, *grid);
    co_return layers;
}

Task<> GridRun::run_displacement() {
    if (material_.displacement) co_await displace();
    if (material_.surface_moves) co_await color(*material_.surface, false, messages_.surface);
}

Task<> GridRun::run(const AovLayout& aovs, const HitOutputs* asked) {
    Layers displaced, surface, atmosphere;
    if (material_.displacement && !grids_.front()->is_end) displaced = co_await displace_seen();
    if (grids_.front()->own_colors) {
        set_own_colors();
    } else {
        if (const LayeredShader* shader = volume(); shader && material_.surface_asks_volume)
            co_await announce_volume(*shader);
        surface = co_await run_surface();
    }
    if (const LayeredShader* shader = volume())
        atmosphere = co_await color(*shader, true, messages_.atmosphere);
    if (asked) answer_hits(*asked, surface, displaced, atmosphere, grids_);
    if (!aovs.empty()) take_aovs(aovs, surface, displaced, context_.camera, grids_);
    // Behind all else: its runs of the surface leave other values in the registers.
    if (asks_light_groups(aovs)) co_await split_light(aovs);
    clouds_.finish();
}

const LayeredShader* GridRun::volume() const {
    return volume_before(*grids_.front(), material_, left_);
}

void GridRun::set_own_colors() {
    for (ShadingGrid* grid : grids_) {
        grid->Ci = grid->Cs, grid->Oi = grid->Os;
        for (size_t i = 0; i < grid->vertex_count(); ++i) grid->Ci.set(i, grid->Cs.at(i) * grid->Os.at(i));
    }
}

/// Fills variables of groups of lights: runs the surface once without lights, and once more for each group. A
/// surface that moves P would move it again: it has all of its light without any.
Task<> GridRun::split_light(const AovLayout& aovs) {
    std::vector<std::pair<Triples, Triples>> whole;
    for (const ShadingGrid* grid : grids_) whole.emplace_back(grid->Ci, grid->Oi);
    const bool splits = material_.surface && !material_.surface_moves && !grids_.front()->own_colors;
    std::vector<Triples> unlit;
    std::vector<const Lamp*> lamps;
    group_lamps_ = &lamps;
    if (splits) co_await run_surface();
    for (const ShadingGrid* grid : grids_) unlit.push_back(grid->Ci);
    for (const Aov& aov : aovs.aovs) {
        const auto group = light_group_asked(aov);
        if (!group) continue;
        const bool is_unlit = *group == kUnlitGroup;
        lamps = lamps_of_group(material_.lights, *group);
        const bool is_lit = splits && !is_unlit && !lamps.empty();
        if (is_lit) co_await run_surface();
        for (size_t g = 0; g < grids_.size(); ++g)
            for (int c = 0; c < 3; ++c) {
                std::vector<float>& plane = grids_[g]->aovs[static_cast<size_t>(aov.offset + c)];
                plane = is_unlit ? unlit[g].c[c] : grids_[g]->Ci.c[c];
                if (is_unlit) continue;
                for (size_t i = 0; i < plane.size(); ++i)
                    plane[i] = is_lit ? plane[i] - unlit[g].c[c][i] : 0.0f;
            }
    }
    group_lamps_ = nullptr;
    for (size_t g = 0; g < grids_.size(); ++g)
        grids_[g]->Ci = std::move(whole[g].first), grids_[g]->Oi = std::move(whole[g].second);
}

Task<GridRun::Layers> GridRun::run_surface() {
    if (rays_) rays_->begin_anew();
    // What is seen through a medium, and what others ask of it, may be any of its variables.
    const bool part = grids_.front()->for_opacity && material_.surface_opacity && !volume();
    const LayeredShader& shader = part ? *material_.surface_opacity : *material_.surface;
    // What the first layer does not name stays as the primitive has it; the rest is taken from the registers.
    const rsl::Program& first = shader.layers.front()->program();
    for (ShadingGrid* grid : grids_) {
        if (!first.find_global("Ci")) grid->Ci = grid->Cs;
        if (!first.find_global("Oi")) grid->Oi = grid->Os;
    }
    co_return co_await color(shader, false, messages_.surface);
}

/// What runs after the surface has its parameters' values before.
Task<> GridRun::announce_volume(const LayeredShader& shader) {
    Layers layers;
    for (size_t layer = 0; layer < shader.layers.size(); ++layer)
        messages_.atmosphere =
            co_await run_layer(shader, layer, read_, batch_, false, layers, Part::Parameters);
}

Task<vm::Registers*> GridRun::run_layer(const LayeredShader& shader, size_t layer,
                                        std::span<const ShadingGrid* const> grids, const vm::Batch& batch,
                                        bool shaded, Layers& layers, Part part) {
    const BoundShader& bound = *shader.layers[layer];
    // Two layers may be the same shader: each has registers of its own, by its number.
    vm::Registers& registers = scratch_.machine.registers(bound.executable(), layer);
    layers.push_back(&registers);
    registers.start(batch.lanes);
    bound.set_parameters(registers, grids);
    if (context_.diagnostics) bound.report_sent(*grids.front(), *context_.diagnostics);
    // Lights that ask for the surface's variables may see them before the surface sets them.
    const bool all = std::ranges::any_of(material_.lights,
                                         [](const Lamp* lamp) { return lamp->asks_surface || lamp->area; });
    const bool stretched = bound.program().kind != rsl::ShaderKind::Displacement;
    GridFootprints footprints(grids, context_.camera, stretched);
    set_variables(registers, grids, context_, footprints, shaded, all);
    // What is within another primitive does not know this one's variables.
    messages_.grids = left_ && &shader == volume() ? std::span<const ShadingGrid* const>() : grids;
    // Lights may ask the surface that asks them.
    if (bound.program().kind == rsl::ShaderKind::Surface) messages_.surface = &registers;
    const Primitive* object = grids.front()->primitive;
    if (left_ && &shader == volume()) object = &context_.scene->primitives[grids.front()->medium.primitive];
    const SceneSpaces spaces(*context_.scene, context_.camera, &bound.instance(), object);
    vm::Context surroundings;
    surroundings.batch = &batch;
    surroundings.spaces = &spaces;
    surroundings.footprints = &footprints;
    surroundings.maps = &maps_;
    // Pieces of borders are vertices of the grids once more.
    const bool bakes = &batch == &batch_ && !group_lamps_;
    clouds_.set_grids(bakes ? grids : std::span<const ShadingGrid* const>());
    surroundings.clouds = &clouds_;
    surroundings.lights = &scratch_.lights;
    surroundings.rays = rays_ ? &*rays_ : nullptr;
    if (rays_) rays_->ask_within_medium(left_ && &shader == volume(), grids.front()->for_opacity);
    surroundings.messages = &messages_;
    surroundings.diagnostics = context_.diagnostics;
    surroundings.near_clip = context_.camera.near_clip, surroundings.far_clip = context_.camera.far_clip;
    surroundings.perspective = context_.camera.perspective;
    surroundings.shutter_open = context_.scene->options.shutter_open;
    surroundings.shutter_close = context_.scene->options.shutter_close;
    // Shadows ask for opacities: area lights that looked for their own shadows there would never end.
    const auto& lights = group_lamps_                 ? *group_lamps_
                         : grids.front()->for_opacity ? material_.other_lights
                                                      : material_.lights;
    scratch_.lights.start(scratch_.machine, lights, group_lamps_ ? material_.lights : lights, surroundings,
                          batch.lanes, variable_planes(registers, "N"), context_.seed,
                          context_.scene->held_from_camera);
    co_await bound.set_run_defaults(scratch_.machine, registers, surroundings, grids);
    if (part == Part::Parameters) co_return &registers;
    shader.connect(layer, layers);
    co_await scratch_.machine.run(registers, surroundings);
    co_return &registers;
}

/// Displaces the pieces of the grids' borders by all layers: what those who share a border point take of it.
Task<> GridRun::move_borders(const LayeredShader& shader) {
    std::vector<ShadingGrid*> borders;
    for (ShadingGrid* grid : grids_)
        for (ShadingGrid& pieces : grid->border) borders.push_back(&pieces);
    // Messages would be answered from the grids' run, which has other lanes.
    const vm::Registers* const of_grids = std::exchange(messages_.displacement, nullptr);
    while (!borders.empty()) {
        const std::vector<ShadingGrid*> run = take_run(borders, shader);
        const std::vector<const ShadingGrid*> read = to_read(run);
        const vm::Batch batch = batch_of(read, true);
        Layers layers;
        messages_.displacement = nullptr;
        for (size_t layer = 0; layer < shader.layers.size(); ++layer) {
            const vm::Registers& registers = *co_await run_layer(shader, layer, read, batch, false, layers);
            if (&shader == material_.displacement) messages_.displacement = &registers;
            size_t first = 0;
            for (ShadingGrid* pieces : run) {
                displace_grid(displaced_by(registers, first, pieces->vertex_count()), *pieces, scratch_.pool);
                first += pieces->vertex_count();
            }
        }
    }
    messages_.displacement = of_grids;
}

/// Moves the grids by what a shader that has run on them made of P and N.
void GridRun::move_grids(const vm::Registers& registers) {
    size_t first = 0;
    for (ShadingGrid* grid : grids_) {
        raise(material_.displacement_reach,
              displace_grid(displaced_by(registers, first, grid->vertex_count()), *grid, scratch_.pool));
        first += grid->vertex_count();
    }
}

/// Records how far a surface shader would move the grids, for report_displacement_bounds().
void GridRun::note_moves(const vm::Registers& registers) {
    if (!writes_variable(registers.program(), "P")) return;
    size_t first = 0;
    for (const ShadingGrid* grid : grids_) {
        raise(material_.displacement_reach,
              longest_move(displaced_by(registers, first, grid->vertex_count()), *grid));
        first += grid->vertex_count();
    }
}

Task<GridRun::Layers> GridRun::displace() {
    const LayeredShader& shader = *material_.displacement;
    const std::vector<BorderWeld> welds = welds_of(grids_);
    co_await move_borders(shader);
    Layers layers;
    for (size_t layer = 0; layer < shader.layers.size(); ++layer) {
        const vm::Registers& registers = *co_await run_layer(shader, layer, read_, batch_, false, layers);
        messages_.displacement = &registers;
        move_grids(registers);
    }
    for (size_t g = 0; g < grids_.size(); ++g) welds[g].close(*grids_[g]);
    co_return layers;
}

/// Runs a shader that sets colours. A surface shader that moves P displaces the surface behind it, as a
/// displacement shader does; `announced` becomes the registers that messages are answered from.
Task<GridRun::Layers> GridRun::color(const LayeredShader& shader, bool shaded,
                                     const vm::Registers*& announced) {
    const bool moves = &shader == material_.surface && material_.surface_moves;
    const std::vector<BorderWeld> welds = moves ? welds_of(grids_) : std::vector<BorderWeld>();
    if (moves) co_await move_borders(shader);
    Layers layers;
    for (size_t layer = 0; layer < shader.layers.size(); ++layer) {
        const bool has_colors = shaded || layer > 0;
        const vm::Registers& registers =
            *co_await run_layer(shader, layer, read_, batch_, has_colors, layers);
        announced = &registers;
        take_colors(registers, grids_);
        if (moves && writes_variable(registers.program(), "P")) move_grids(registers);
        if (&shader == material_.surface && material_.surface_only_sets_P) note_moves(registers);
    }
    for (size_t g = 0; g < welds.size(); ++g) welds[g].close(*grids_[g]);
    co_return layers;
}

}  // namespace trapeze
