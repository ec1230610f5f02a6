#include "shade/materials/area_samples.h"

#include <cmath>

#include "core/motion_keys.h"
#include "core/random.h"
#include "core/ray_sequence.h"
#include "core/scene/scene.h"
#include "core/scene/shading_grid.h"
#include "shade/materials/copy_operand.h"

namespace trapeze {
namespace {

/// Planes of samples_, by number: P, N and radiance have three planes each.
constexpr size_t kSampleP = 0, kSampleN = 3, kRadiance = 6, kSolidAngle = 9, kArea = 10, kSamplePlanes = 11;
/// Behind these, where the light's shader asks: two planes each, and three.
constexpr size_t kUv = 11, kSt = 13, kDPdu = 15, kDPdv = 18, kPlanesWithPlace = 21;

/// Tells the seeds of area lights from those of other random numbers at a vertex.
constexpr uint32_t kAreaLights = 0x6c616d70, kLightTimes = 0x74696d65;

/// Rays of a grid's surface have times of their own: it asks for that, or has been hit at one.
bool has_times(const ShadingGrid& grid) {
    return grid.hit_vertex >= 0 ? grid.hit_time > 0 : grid.primitive->attributes->rays.sample_motion;
}

/// When a sample of an area light is taken for a vertex: where rays of its surface have times of their own,
/// at one of these; for what a ray has hit when that was; else at shutter open.
float time_of_sample(int sample, uint32_t seed, const ShadingGrid* grid) {
    if (!grid) return 0;
    if (grid->hit_vertex >= 0) return grid->hit_time;
    return grid->primitive->attributes->rays.sample_motion ? shutter_time(sample, unit_float(seed)) : 0;
}

}  // namespace

void AreaSamples::start(const vm::Context& surroundings, size_t lanes, const Plane3& N, uint32_t seed,
                        std::span<const M44f> held) {
    surroundings_ = &surroundings;
    lanes_ = lanes;
    N_ = N;
    seed_ = seed;
    held_ = held;
    has_times_ = false;
    surface_turns_.clear();
    if (!surroundings_->batch) return;
    for (const vm::GridSpan& span : surroundings_->batch->spans) {
        const bool has = span.grid && has_times(*span.grid);
        surface_turns_.push_back(has ? turn_of(*span.grid, held) : MotionTurn());
        has_times_ |= has;
    }
}

/// Of what deforms; what else turns does so with its space. What a ray has hit knows no motion of the camera,
/// here as in turn_of().
VertexMotion AreaSamples::motion_of(const vm::GridSpan& span, size_t vertex) const {
    if (!span.grid || !has_times(*span.grid) || span.grid->primitive->shape_keys.size() <= 1) return {};
    return {*span.grid, vertex, span.grid->hit_vertex >= 0 ? std::span<const M44f>() : held_};
}

std::vector<float> AreaSamples::take(const Turn& turn, const Lamp& lamp, const vm::Operand& P) {
    const bool asks_place = lamp.asks_place;
    samples_.assign((asks_place ? kPlanesWithPlace : kSamplePlanes) * lanes_, 0);
    const auto put = [&](size_t plane, size_t lane, const V3f& v) {
        for (int k = 0; k < 3; ++k) samples_[(plane + static_cast<size_t>(k)) * lanes_ + lane] = v[k];
    };
    const bool has_normals = N_.size() == lanes_;
    std::vector<float> times(lamp.moves() || has_times_ ? lanes_ : 0);
    turned_.assign(lanes_, 0);
    // A lane, and the grid's vertex that it is.
    struct Lit {
        size_t lane;
        uint32_t seed;
        const ShadingGrid* grid = nullptr;
        size_t vertex = 0;
        const MotionTurn* space = nullptr;
        VertexMotion surface;
    };
    const auto choose = [&](const Lit& lit) {
        const size_t lane = lit.lane;
        float time = 0;
        if (!times.empty()) {
            time = time_of_sample(turn.sample, hash(lit.seed, turn.number, kLightTimes), lit.grid);
            times[lane] = time = lamp.moves() ? lamp.time_near(time) : time;
        }
        const LightSampler* const sampler = lamp.sampler_at(time);
        if (!sampler) return;
        const V3f point(vm::Run::at(P, 0, lane), vm::Run::at(P, 1, lane), vm::Run::at(P, 2, lane));
        V3f normal = has_normals ? V3f(N_[0][lane], N_[1][lane], N_[2][lane]) : V3f(0);
        const bool is_hit = lit.grid && lit.vertex < lit.grid->I.size();
        if (normal.dot(is_hit ? lit.grid->I.at(lit.vertex) : eye_way(*surroundings_, point)) > 0)
            normal = -normal;
        // A single direction lights what turns as it lies at shutter open, as lights without a shape do.
        if (lit.space && !sampler->is_point()) {
            turned_[lane] = time;
            normal = lit.surface.forward(normal, time, *lit.space);
        }
        const RaySequence sequence(hash(lit.seed, turn.number, kAreaLights), turn.samples);
        const LightSample made = sampler->sample(point, normal, sequence[turn.sample]);
        put(kSampleP, lane, made.P), put(kSampleN, lane, made.N), put(kRadiance, lane, made.radiance);
        samples_[kSolidAngle * lanes_ + lane] = std::isfinite(made.solid_angle) ? made.solid_angle : 0;
        samples_[kArea * lanes_ + lane] = sampler->area();
        if (!asks_place) return;
        put(kDPdu, lane, made.dPdu), put(kDPdv, lane, made.dPdv);
        for (size_t k = 0; k < 2; ++k) {
            samples_[(kUv + k) * lanes_ + lane] = made.uv[static_cast<int>(k)];
            samples_[(kSt + k) * lanes_ + lane] = made.st[static_cast<int>(k)];
        }
    };
    if (!surroundings_->batch)
        for (size_t lane = 0; lane < lanes_; ++lane)
            choose({lane, hash(static_cast<uint32_t>(lane), seed_), nullptr, 0, nullptr, {}});
    else
        for (size_t number = 0; number < surroundings_->batch->spans.size(); ++number) {
            const vm::GridSpan& span = surroundings_->batch->spans[number];
            const uint32_t grid = span.word(seed_);
            for (size_t i = 0; i < static_cast<size_t>(span.shape.vertex_count()); ++i)
                choose({span.first + i, hash(grid, static_cast<uint32_t>(i)), span.grid, i,
                        &surface_turns_[number], motion_of(span, i)});
        }
    return times;
}

void AreaSamples::turn_back(float* L) const {
    if (!has_times_) return;
    for (size_t number = 0; number < surface_turns_.size(); ++number) {
        const MotionTurn& space = surface_turns_[number];
        const vm::GridSpan& span = surroundings_->batch->spans[number];
        if (space.is_none() && !motion_of(span, 0).deforms()) continue;
        for (size_t i = 0; i < static_cast<size_t>(span.shape.vertex_count()); ++i) {
            const size_t lane = span.first + i;
            const V3f way(L[lane], L[lanes_ + lane], L[2 * lanes_ + lane]);
            const V3f back = motion_of(span, i).back(way, turned_[lane], space);
            for (int k = 0; k < 3; ++k) L[static_cast<size_t>(k) * lanes_ + lane] = back[k];
        }
    }
}

void AreaSamples::tell(const Lamp& lamp, vm::Registers& registers) const {
    const auto planes = [&](size_t plane) {
        return planes_of(const_cast<float*>(samples_.data()) + plane * lanes_, lanes_);  // an input
    };
    const rsl::Program& program = registers.program();
    const auto set = [&](const char* name, size_t plane, int width) {
        if (const rsl::RegisterId* id = program.find_global(name))
            copy_operand(planes(plane), width, lanes_, registers.operand(*id));
    };
    set("P", kSampleP, 3), set("N", kSampleN, 3), set("Ng", kSampleN, 3);
    if (samples_.size() == kPlanesWithPlace * lanes_) {
        set("u", kUv, 1), set("v", kUv + 1, 1), set("s", kSt, 1), set("t", kSt + 1, 1);
        set("dPdu", kDPdu, 3), set("dPdv", kDPdv, 3);
    }
    for (const rsl::ProgramParameter& parameter : program.parameters) {
        const bool is_number = parameter.type == rsl::Type{rsl::Base::Float, 0};
        if (parameter.name == "__solidangle" && is_number)
            copy_operand(planes(kSolidAngle), 1, lanes_, registers.operand(parameter.id));
        if (parameter.name == "__radiance" && parameter.type == rsl::Type{rsl::Base::Color, 0})
            copy_operand(planes(kRadiance), 3, lanes_, registers.operand(parameter.id));
        if (parameter.name != "__area" || !is_number) continue;
        if (registers.operand(parameter.id).lane_mask) {
            copy_operand(planes(kArea), 1, lanes_, registers.operand(parameter.id));
        } else {  // one for all times: that of shutter open
            const LightSampler* const at_open = lamp.sampler_at(0);
            const float area = at_open ? at_open->area() : 0;
            registers.set_uniform(parameter.id, &area);
        }
    }
}

}  // namespace trapeze
