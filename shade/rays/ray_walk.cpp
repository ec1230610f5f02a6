#include "shade/rays/ray_walk.h"

#include <algorithm>
#include <bit>
#include <tuple>

#include "shade/rays/inside_search.h"

namespace trapeze {
namespace {

/// Hits that are shaded together; and rays in memory at once, about.
constexpr size_t kShadedTogether = 256;
constexpr size_t kRaysAtOnce = 4096;
/// The most surfaces that a ray looks through: a bound on scenes where next to nothing stops it. Otherwise it
/// goes on as long as light is left. Behind the last one it ends as where nothing is hit: what has been seen,
/// and what is left of the light, stay as they are.
constexpr int kMostLayersOfRay = 4096;
/// Less light than this is none: half of the smallest step of eight bits.
constexpr float kNothingLeft = 1.0f / 512;

uint64_t& count_of(RayKind kind, RayStats& stats) {
    return kind == RayKind::Diffuse    ? stats.diffuse
           : kind == RayKind::Specular ? stats.specular
                                       : stats.transmission;
}

float largest(const V3f& v) {
    return std::max({v.x, v.y, v.z});
}

/// Whether shaders are to displace what rays meet.
bool is_displaced(const Attributes& attributes) {
    return attributes.rays.displaced && (attributes.displacement || attributes.displacement_bound > 0);
}

/// Some order by the numbers that came along with rays: equal ones, which can share a run, come together.
bool is_sent_less(const ShadingGrid* a, const ShadingGrid* b) {
    for (size_t i = 0; i < a->sent.size(); ++i)
        for (size_t p = 0; p < a->sent[i].variable.planes.size(); ++p) {
            const auto of_a = std::bit_cast<uint32_t>(a->sent[i].variable.planes[p].front());
            const auto of_b = std::bit_cast<uint32_t>(b->sent[i].variable.planes[p].front());
            if (of_a != of_b) return of_a < of_b;
        }
    return false;
}

std::vector<const RaySegment*> segments_of(std::span<const WalkedRay> rays) {
    std::vector<const RaySegment*> segments;
    segments.reserve(rays.size());
    for (const WalkedRay& ray : rays) segments.push_back(&ray.segment);
    return segments;
}

/// Whether a hit hides all light, whatever its opacity and what it is seen through.
bool is_opaque_by_attribute(const RaySurfaceHit& hit, const RayAsk& ask) {
    return !ask.hit_mode && ask.kind == RayKind::Transmission &&
           hit.attributes->transmission_hits == RayAsk::HitMode::Opaque;
}

/// What the attributes of a hit say that it stands for.
RayAsk::HitMode mode_of(const RayAttributes& attributes, RayKind kind, bool opacity_alone) {
    using HitMode = RayAsk::HitMode;
    if (kind == RayKind::Transmission) return attributes.transmission_hits;
    if (kind == RayKind::Specular) return attributes.specular_hits;
    return attributes.diffuse_hits.value_or(opacity_alone ? HitMode::Primitive : HitMode::Shader);
}

}  // namespace

size_t rays_at_once(const RayScene& scene) {
    return std::max(scene.rays_at_once(), kRaysAtOnce);
}

Task<> RayWalk::radiance(std::span<WalkedRay> rays, const RayAsk& ask) {
    std::vector<WalkedRay*> all;
    for (WalkedRay& ray : rays) all.push_back(&ray);
    co_await walk(all, {}, ask, Wants::Color);
    count_of(ask.kind, stats_) += rays.size();
}

Task<> RayWalk::transmission(std::span<WalkedRay> rays, const RayAsk& ask, bool with_distance) {
    std::vector<WalkedRay*> open;  // it is not known at once whether they are blocked
    std::vector<WalkedRay*> free;
    const bool walks = with_distance || ask.hit_mode;
    std::vector<std::optional<bool>> blocked(rays.size());
    if (!walks) scene_.blocked(segments_of(rays), ask.kind, blocked);
    for (size_t i = 0; i < rays.size(); ++i) {
        if (rays[i].first) blocked[i].reset();
        if (!blocked[i]) open.push_back(&rays[i]);
        if (blocked[i].value_or(false)) rays[i].through = V3f(0, 0, 0);
        if (!blocked[i].value_or(true) && ends_in_media(rays[i], ask)) free.push_back(&rays[i]);
    }
    count_of(ask.kind, stats_) += rays.size();
    co_await walk(open, std::move(free), ask, Wants::Opacity);
}

/// Of two rays that begin side by side, within a part of a side: the second one tells where the first one has
/// come by what is in its way, else the first one is exact.
void RayWalk::ask_witnesses(std::span<WalkedRay> rays, const RayAsk& ask) {
    std::vector<WalkedRay> seconds;
    std::vector<WalkedRay*> firsts;
    for (WalkedRay& ray : rays) {
        if (ray.witness == V3f(0, 0, 0)) continue;
        firsts.push_back(&ray);
        WalkedRay& second = seconds.emplace_back(ray);
        second.segment.origin += ray.witness, second.moved += ray.witness;
    }
    std::vector<std::optional<RaySurfaceHit>> hits(seconds.size());
    scene_.closest(segments_of(seconds), ask.kind, hits);
    for (size_t i = 0; i < seconds.size(); ++i) {
        if (!hits[i]) continue;
        seconds[i].distance = hits[i]->distance;
        const float told = seconds[i].told_distance();
        if (told < firsts[i]->distance - firsts[i]->segment.left.most) firsts[i]->distance = told;
    }
}

void RayWalk::distance(std::span<WalkedRay> rays, const RayAsk& ask) {
    std::vector<std::optional<RaySurfaceHit>> hits(rays.size());
    scene_.closest(segments_of(rays), ask.kind, hits);
    for (size_t i = 0; i < rays.size(); ++i) {
        if (rays[i].first) hits[i] = *rays[i].first;
        if (hits[i]) rays[i].distance = hits[i]->distance;
    }
    count_of(ask.kind, stats_) += rays.size();
    ask_witnesses(rays, ask);
}

/// All go on together, a surface farther each time; `free`: rays that are known to meet none before their
/// ends.
Task<> RayWalk::walk(std::span<WalkedRay* const> rays, std::vector<WalkedRay*> free, const RayAsk& ask,
                     Wants wants) {
    std::vector<WalkedRay*> going(rays.begin(), rays.end());
    std::vector<const RaySegment*> segments;
    std::vector<std::optional<RaySurfaceHit>> hits;
    std::vector<Met> met;
    std::vector<std::unique_ptr<RayAhead>> ahead;  // of rays
    const int layers = ask.first_alone ? 1 : kMostLayersOfRay;
    for (int layer = 0; layer < layers && !going.empty(); ++layer) {
        segments.clear(), met.clear();
        for (const WalkedRay* ray : going) segments.push_back(&ray->segment);
        hits.resize(going.size());
        scene_.closest(segments, ask.kind, hits);
        for (size_t i = 0; i < going.size(); ++i) {
            if (layer == 0 && going[i]->first) hits[i] = *going[i]->first;
            if (!hits[i] && ends_in_media(*going[i], ask)) free.push_back(going[i]);
            if (!hits[i]) continue;
            going[i]->distance = std::min(going[i]->distance, hits[i]->distance);
            met.push_back({going[i], *hits[i]});
        }
        going.clear();
        for (size_t first = 0; first < met.size(); first += kShadedTogether) {
            const auto some = std::span(met).subspan(first, std::min(kShadedTogether, met.size() - first));
            co_await visit_hits(some, ask, wants, layer == 0);
            for (const Met& one : some)
                if (pass(one, ask)) {
                    going.push_back(one.ray);
                    if (layer == 0) one.ray->segment.ahead = ahead.emplace_back(scene_.look_ahead()).get();
                }
        }
    }
    for (WalkedRay* ray : rays) ray->segment.ahead = nullptr;
    if (!free.empty()) co_await come_to_ends(free, ask, wants);
}

/// Adds to what a ray has seen; whether any light is left.
bool RayWalk::see(WalkedRay& ray, const V3f& color, const V3f& opacity) {
    ray.seen += ray.through * color;
    for (int k = 0; k < 3; ++k) ray.through[k] *= 1 - std::clamp(opacity[k], 0.0f, 1.0f);
    if (largest(ray.through) > kNothingLeft) return true;
    ray.through = V3f(0, 0, 0);
    return false;
}

/// Adds a surface to what its ray has seen; whether the ray goes on behind it. Attributes::matte means
/// nothing here: what is held out of the picture is held out of the camera's view alone, and reflections and
/// shadows have it.
bool RayWalk::pass(const Met& met, const RayAsk& ask) const {
    WalkedRay& ray = *met.ray;
    const bool own = met.vertex < 0;
    const bool hides_all = is_opaque_by_attribute(met.hit, ask);
    const V3f opacity = hides_all ? V3f(1, 1, 1)
                        : own     ? met.hit.opacity
                                  : met.grid->Oi.at(static_cast<size_t>(met.vertex));
    const V3f color = own ? met.hit.color * opacity : met.grid->Ci.at(static_cast<size_t>(met.vertex));
    if (!see(ray, color, opacity)) return false;
    if (ask.opaque) {
        bool ends = true;
        for (int k = 0; k < 3; ++k) ends &= 1 - ray.through[k] >= (*ask.opaque)[k];
        if (ends) return false;
    }
    ray.medium = {met.hit.primitive, met.hit.from_outside}, ray.medium_from = met.hit.distance;
    go_behind(scene_, met.hit, ray.segment);
    return true;
}

/// Whether a hit's shaders have to run.
bool RayWalk::shades(const RaySurfaceHit& hit, const RayAsk& ask, Wants wants) const {
    if (!ask.shades) return false;
    if (wants == Wants::Opacity && hit.keeps_opacity && !ask.hit_mode) return false;
    return ask.hit_mode.value_or(mode_of(*hit.attributes, ask.kind, wants == Wants::Opacity)) ==
           RayAsk::HitMode::Shader;
}

/// What hits are seen through, if that has a shader. A ray may begin within a thing that stands close to
/// where it was sent from, or that stands around all: then it is the thing that tells. Of what is opaque by
/// itself nothing more is asked where opacity is wanted alone.
void RayWalk::find_media(std::span<Met> met, const RayAsk& ask, Wants wants) const {
    if (volumes_.empty() || !ask.shades) return;
    InsideSearch search(scene_, volumes_, ask.kind);
    for (Met& one : met) {
        if (is_opaque_by_attribute(one.hit, ask)) continue;
        const bool hides = wants == Wants::Opacity && one.hit.keeps_opacity && one.hit.opacity == V3f(1);
        if (volumes_.has(one.ray->medium))
            one.medium = one.ray->medium;
        else if (volumes_.has_insides() && !hides)
            search.add_before(one.ray->segment, one.hit, one.medium);
    }
    search.run();
}

ShadingGrid& RayWalk::grid_of_number(size_t number) {
    if (scratch_.grids.size() <= number) scratch_.grids.emplace_back();
    return scratch_.grids[number];
}

/// Sets what the ray sends to the shaders that run on a grid.
void RayWalk::send(const WalkedRay& ray, const RayAsk& ask, ShadingGrid& grid) {
    grid.sent.assign(ask.sent.begin(), ask.sent.end());
    const float* number = ray.sent;
    for (SentVariable& sent : grid.sent)
        for (std::vector<float>& plane : sent.variable.planes) plane.front() = *number++;
}

/// The grid of a hit, of which its ray sees the vertex that was hit.
ShadingGrid& RayWalk::grid_of(Met& met, const RayAsk& ask, size_t number) {
    ShadingGrid& grid = grid_of_number(number);
    const int vertex = scene_.dice(met.hit, grid);
    const RaySegment& ray = met.ray->segment;
    grid.hit_vertex = vertex, grid.hit_time = ray.time, grid.hit_level = met.hit.level;
    // A micropolygon passes beside the limit surface.
    const V3f place = ray.origin + ray.direction * met.hit.distance;
    if (is_displaced(*grid.primitive->attributes))
        grid.hit_place = place;
    else
        move_hit_to(place, grid);
    // Seen through a medium, from where that begins.
    grid.medium = met.medium;
    const bool in_medium = grid.medium != RayMedium();
    grid.hit_from = in_medium ? ray.origin + ray.direction * met.ray->medium_from : ray.origin;
    // What begins on the surface that it hits comes from somewhere all the same.
    if (met.hit.distance <= 0) grid.hit_from = place - ray.direction * scene_.spacing(place);
    grid.hit_ray = met.ray->footprint.behind(met.hit.distance);
    see_hit(grid);
    grid.seed = met.ray->seed;
    grid.answers.clear();
    send(*met.ray, ask, grid);
    met.grid = &grid;
    return grid;
}

/// Shades hits, and asks the first ones. Hits of one primitive are shaded side by side; in which order
/// changes nothing but the time.
Task<> RayWalk::visit_hits(std::span<Met> met, const RayAsk& ask, Wants wants, bool first) {
    HitVisit visit;
    visit.kind = ask.kind, visit.label = ask.label, visit.depths = ask.depths;
    visit.outputs = first ? ask.outputs : nullptr;
    const bool asks = visit.outputs && !visit.outputs->empty();
    std::vector<ShadingGrid*> shaded, asked;
    find_media(met, ask, wants);
    for (Met& one : met) {
        const bool own_colors = !shades(one.hit, ask, wants);
        const bool runs = !own_colors || one.medium != RayMedium();
        if (!runs && !asks) continue;
        ShadingGrid& grid = grid_of(one, ask, shaded.size() + asked.size());
        grid.for_opacity = wants == Wants::Opacity, grid.own_colors = own_colors;
        if (runs) one.vertex = grid.hit_vertex;
        (runs ? shaded : asked).push_back(&grid);
    }
    stats_.shaded_hits += shaded.size();
    for (std::vector<ShadingGrid*>* grids : std::array{&shaded, &asked}) {
        visit.shades = grids == &shaded;
        if (!ask.sent.empty()) std::ranges::stable_sort(*grids, is_sent_less);
        std::ranges::stable_sort(*grids, {}, [](const ShadingGrid* grid) {
            return std::tuple(grid->primitive_index, grid->medium, grid->own_colors);
        });
        if (!grids->empty()) co_await shade_(*grids, visit);
    }
    for (const Met& one : met)
        if (asks && one.ray->answers && one.grid) std::ranges::copy(one.grid->answers, one.ray->answers);
}

}  // namespace trapeze
