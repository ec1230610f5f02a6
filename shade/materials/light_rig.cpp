#include "shade/materials/light_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>

#include "core/motion_keys.h"
#include "core/random.h"
#include "core/ray_sequence.h"
#include "core/scene/scene.h"
#include "core/scene/shading_grid.h"
#include "shade/vm/kernels/light_kernels.h"

namespace trapeze {
namespace {

/// A light's planes in a Slot, by number: L, its direction and Cl have three planes each, the mask of lit
/// lanes one.
constexpr size_t kL = 0, kDirection = 3, kCl = 6, kLit = 9, kPlanes = 10;

/// Planes of samples_, by number: P, N and radiance have three planes each.
constexpr size_t kSampleP = 0, kSampleN = 3, kRadiance = 6, kSolidAngle = 9, kArea = 10, kSamplePlanes = 11;

/// Tells the seeds of area lights from those of other random numbers at a vertex.
constexpr uint32_t kAreaLights = 0x6c616d70, kLightTimes = 0x74696d65;

/// An operand whose components differ from lane to lane and lie one plane after the other.
vm::Operand planes_of(float* first, size_t lanes) {
    vm::Operand operand;
    operand.data = first;
    operand.lane_mask = ~size_t{0};
    operand.stride = lanes;
    return operand;
}

/// The value of an output parameter, a float, at the first vertex; `fallback` when there is none.
float output_number(const vm::Registers& registers, std::string_view name, float fallback) {
    for (const rsl::ProgramParameter& parameter : registers.program().parameters)
        if (parameter.name == name && parameter.type == rsl::Type{rsl::Base::Float, 0})
            return registers.operand(parameter.id).data[0];
    return fallback;
}

/// Copies `width` components; a uniform target takes the first lane of a varying source.
void copy_operand(const vm::Operand& from, int width, size_t lanes, const vm::Operand& to) {
    const size_t plane = to.lane_mask ? lanes : kLanes;
    for (int k = 0; k < width; ++k) {
        const float* source = from.data + static_cast<size_t>(k) * from.stride;
        float* target = to.data + static_cast<size_t>(k) * to.stride;
        if (from.lane_mask && to.lane_mask)
            std::memcpy(target, source, plane * sizeof(float));
        else
            std::fill_n(target, plane, source[0]);
    }
}

/// Rays of a grid's surface have times of their own: it asks for that, or has been hit at one.
bool has_times(const ShadingGrid& grid) {
    return grid.hit_vertex >= 0 ? grid.hit_time > 0 : grid.primitive->attributes->rays.sample_motion;
}

/// Numbers of the registers (Machine::registers()) of lights that are given values begin here: others have
/// the number of the light.
constexpr size_t kTold = size_t{1} << 32;

/// A value for some lanes of a parameter that varies, component by component of all elements; for all where
/// it is the same everywhere.
void give_lanes(const vm::SentValue& sent, size_t lanes, const uint32_t* mask, const vm::Operand& to) {
    const int width = rsl::width_of(sent.type.base);
    for (size_t e = 0; e < static_cast<size_t>(std::max(sent.type.length, 1)); ++e)
        for (size_t k = 0; k < static_cast<size_t>(width); ++k) {
            const float* const source =
                sent.value.data + e * sent.value.element_stride + k * sent.value.stride;
            float* const target = to.data + e * to.element_stride + k * to.stride;
            for (size_t i = 0; i < lanes; ++i)
                if (mask[i] || !sent.value.lane_mask) target[i] = source[i & sent.value.lane_mask];
        }
}

/// When a sample of an area light is taken for a vertex: where rays of its surface have times of their own,
/// at one of these; for what a ray has hit when that was; else at shutter open.
float time_of_sample(int sample, uint32_t seed, const ShadingGrid* grid) {
    if (!grid) return 0;
    if (grid->hit_vertex >= 0) return grid->hit_time;
    return grid->primitive->attributes->rays.sample_motion ? shutter_time(sample, unit_float(seed)) : 0;
}

}  // namespace

int Lamp::turns() const {
    if (!area) return 1;
    for (const auto& sampler : samplers)
        if (sampler) return sampler->is_point() && !moves() ? 1 : area->shape->samples;
    return 0;
}

float Lamp::time_near(float time) const {
    return moves() && time > 0 ? middle_of_part(part_of_shutter(time, parts()), parts()) : 0;
}

const LightSampler* Lamp::sampler_at(float time) const {
    if (samplers.empty()) return nullptr;
    return samplers[moves() && time > 0 ? 1 + part_of_shutter(time, parts()) : 0].get();
}

void LightRig::start(vm::Machine& machine, const std::vector<const Lamp*>& lamps,
                     const vm::Context& surroundings, size_t lanes, const Plane3& N, uint32_t seed,
                     std::span<const M44f> held) {
    machine_ = &machine;
    lamps_ = &lamps;
    surroundings_ = &surroundings;
    lanes_ = lanes;
    N_ = N;
    seed_ = seed;
    turns_.clear();
    int wanted = 0;
    for (const Lamp* lamp : lamps) wanted += lamp->turns();
    for (uint32_t i = 0; i < lamps.size(); ++i) {
        const int asked = lamps[i]->turns();
        const int samples =
            wanted > kMostTurns && asked > 1 ? std::max(1, asked * kMostTurns / wanted) : asked;
        for (int s = 0; s < samples; ++s) turns_.push_back({i, s, samples});
    }
    if (std::ranges::any_of(lamps, [](const Lamp* lamp) { return lamp->area != nullptr; }))
        find_surface_motion(held);
    while (slots_.size() < turns_.size()) slots_.emplace_back();
    for (Slot& slot : slots_) {
        slot.lasts = false;
        slot.arriving.registers = nullptr;
    }
}

/// Whether and how surfaces move while light is sampled.
void LightRig::find_surface_motion(std::span<const M44f> held) {
    has_times_ = false;
    surface_turns_.clear();
    if (!surroundings_->batch) return;
    for (const vm::GridSpan& span : surroundings_->batch->spans) {
        const bool has = span.grid && has_times(*span.grid);
        surface_turns_.push_back(has ? turn_of(*span.grid, held) : MotionTurn());
        has_times_ |= has;
    }
}

Task<const vm::Lights::Arriving*> LightRig::arriving(size_t light, const vm::LightRequest& request) {
    if (!request.sent.empty()) {
        const std::vector<Taken> taken = taken_by(lamp(light), request);
        if (!taken.empty()) {
            while (told_.size() <= request.depth) told_.emplace_back();
            Slot& slot = told_[request.depth];
            co_await run(light, slot, request, taken);
            co_return &slot.arriving;
        }
    }
    Slot& slot = slots_[light];
    if (request.lasting && slot.lasts && !request.refresh) co_return &slot.arriving;
    co_await run(light, slot, request, {});
    slot.lasts = request.lasting;
    co_return &slot.arriving;
}

/// Types fit as they do in messages: by their numbers, so that a normal may be given for a vector.
std::vector<LightRig::Taken> LightRig::taken_by(const Lamp& lamp, const vm::LightRequest& request) const {
    std::vector<Taken> taken;
    if (!lamp.told) return taken;
    const rsl::Program& program = lamp.told->program();
    for (const vm::SentValue& sent : request.sent) {
        const auto has_name = [&](const rsl::ProgramParameter& p) { return p.name == sent.name; };
        const auto at = std::ranges::find_if(program.parameters, has_name);
        if (at == program.parameters.end()) continue;
        const auto numbers = [](const rsl::Type& type) { return rsl::width_of(type.base); };
        if (at->type.length == sent.type.length && numbers(at->type) == numbers(sent.type))
            taken.push_back({static_cast<size_t>(at - program.parameters.begin()), &sent});
        else if (surroundings_->diagnostics)
            surroundings_->diagnostics->warning(
                request.at,
                fmt::format("light shader \"{}\" declares \"{}\" as another type than what illuminance "
                            "sends, and does not take it",
                            program.name, sent.name),
                fmt::format("rsl-sent-type {} {}", program.name, sent.name));
    }
    return taken;
}

/// Texts are the same in all lanes.
void LightRig::give(vm::Registers& registers, std::span<const Taken> taken, const uint32_t* lanes) const {
    for (const Taken& one : taken) {
        const rsl::RegisterId id = registers.program().parameters[one.parameter].id;
        for (size_t e = 0; e < one.value->texts.size(); ++e) registers.text(id, e) = one.value->texts[e];
        if (one.value->texts.empty()) give_lanes(*one.value, lanes_, lanes, registers.operand(id));
    }
}

void LightRig::set_variables(vm::Registers& registers, const Lamp& lamp, const vm::Operand& P) const {
    using vm::Predefined;
    for (const vm::StartValue& value : registers.executable().start_values()) {
        const rsl::RegisterId id = value.id;
        const vm::Operand& operand = registers.operand(id);
        const Predefined variable = value.variable;
        if (lamp.area && (variable == Predefined::P || variable == Predefined::N)) {
            continue;                                                          // set_sample()
        } else if (variable == Predefined::Ps || variable == Predefined::I) {  // the eye is at the origin
            copy_operand(P, 3, lanes_, operand);
        } else if (variable == Predefined::P) {
            registers.set_uniform(id, &lamp.position.x);
        } else if ((variable == Predefined::N || variable == Predefined::Ns) && N_.size() == lanes_) {
            for (int k = 0; k < 3; ++k)
                std::memcpy(operand.data + static_cast<size_t>(k) * operand.stride, N_[k].data(),
                            lanes_ * sizeof(float));
        } else if (variable == Predefined::RayOrigin || variable == Predefined::RayWay) {
            set_ray(operand, variable == Predefined::RayWay, P);
        } else if (rsl::width_of(registers.reg(id).type.base) > 0) {
            const float zeros[16] = {};
            registers.set_uniform(id, zeros);
        }
    }
}

/// From the eye to a point that the camera sees.
V3f LightRig::eye_way(const V3f& point) const {
    return surroundings_->perspective ? point : V3f(0, 0, point.z);
}

/// Of the rays that have hit the points which are lit: where they began, or the `way` from there to P. The
/// camera's begin in the eye, or on the eye's plane.
void LightRig::set_ray(const vm::Operand& out, bool way, const vm::Operand& P) const {
    const auto put = [&](size_t lane, const ShadingGrid* grid, size_t vertex) {
        const V3f here = vm::Run::triple_at(P, lane);
        V3f origin = here - eye_way(here);
        if (grid && vertex < grid->I.size()) origin = grid->P.front().at(vertex) - grid->I.at(vertex);
        for (int k = 0; k < 3; ++k)
            out.data[static_cast<size_t>(k) * out.stride + lane] = way ? here[k] - origin[k] : origin[k];
    };
    for (size_t lane = 0; lane < lanes_; ++lane) put(lane, nullptr, 0);
    if (!surroundings_->batch) return;
    for (const vm::GridSpan& span : surroundings_->batch->spans)
        for (size_t i = 0; span.grid && i < span.grid->I.size(); ++i) put(span.first + i, span.grid, i);
}

/// Chooses a place of the light's shape for each vertex. Random numbers follow from the vertex and the lamp
/// [decision 0019]: a vertex' places are well apart, and those of vertices have nothing in common. Returns
/// when each is taken, where the light moves or rays have times of their own; else nothing.
std::vector<float> LightRig::sample(const Turn& turn, const Lamp& lamp, const vm::Operand& P) {
    samples_.assign(kSamplePlanes * lanes_, 0);
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
        const MotionTurn* surface = nullptr;
    };
    const auto take = [&](const Lit& lit) {
        const size_t lane = lit.lane;
        float time = 0;
        if (!times.empty()) {
            time = time_of_sample(turn.sample, hash(lit.seed, turn.lamp, kLightTimes), lit.grid);
            times[lane] = time = lamp.moves() ? lamp.time_near(time) : time;
        }
        const LightSampler* const sampler = lamp.sampler_at(time);
        if (!sampler) return;
        const V3f point(vm::Run::at(P, 0, lane), vm::Run::at(P, 1, lane), vm::Run::at(P, 2, lane));
        V3f normal = has_normals ? V3f(N_[0][lane], N_[1][lane], N_[2][lane]) : V3f(0);
        const bool is_hit = lit.grid && lit.vertex < lit.grid->I.size();
        if (normal.dot(is_hit ? lit.grid->I.at(lit.vertex) : eye_way(point)) > 0) normal = -normal;
        // A single direction lights what turns as it lies at shutter open, as lights without a shape do.
        if (lit.surface && !sampler->is_point()) {
            turned_[lane] = time;
            normal = lit.surface->forward(normal, time);
        }
        const RaySequence sequence(hash(lit.seed, turn.lamp, kAreaLights), turn.samples);
        const LightSample made = sampler->sample(point, normal, sequence[turn.sample]);
        put(kSampleP, lane, made.P), put(kSampleN, lane, made.N), put(kRadiance, lane, made.radiance);
        samples_[kSolidAngle * lanes_ + lane] = std::isfinite(made.solid_angle) ? made.solid_angle : 0;
        samples_[kArea * lanes_ + lane] = sampler->area();
    };
    if (!surroundings_->batch)
        for (size_t lane = 0; lane < lanes_; ++lane) take({lane, hash(static_cast<uint32_t>(lane), seed_)});
    else
        for (size_t number = 0; number < surroundings_->batch->spans.size(); ++number) {
            const vm::GridSpan& span = surroundings_->batch->spans[number];
            const uint32_t grid =
                hash(static_cast<uint32_t>(span.seed), static_cast<uint32_t>(span.seed >> 32), seed_);
            for (size_t i = 0; i < static_cast<size_t>(span.shape.vertex_count()); ++i)
                take({span.first + i, hash(grid, static_cast<uint32_t>(i)), span.grid, i,
                      &surface_turns_[number]});
        }
    return times;
}

/// Turns the ways to samples back to how surfaces lie as they are shaded; `L`: 3 planes.
void LightRig::turn_back(float* L) const {
    if (!has_times_) return;
    for (size_t number = 0; number < surface_turns_.size(); ++number) {
        const MotionTurn& surface = surface_turns_[number];
        if (surface.is_none()) continue;
        const vm::GridSpan& span = surroundings_->batch->spans[number];
        for (size_t i = 0; i < static_cast<size_t>(span.shape.vertex_count()); ++i) {
            const size_t lane = span.first + i;
            const V3f way(L[lane], L[lanes_ + lane], L[2 * lanes_ + lane]);
            const V3f back = surface.back(way, turned_[lane]);
            for (int k = 0; k < 3; ++k) L[static_cast<size_t>(k) * lanes_ + lane] = back[k];
        }
    }
}

/// P and N are the sample's; "__solidangle", "__radiance" and "__area" tell the shader what it stands for.
void LightRig::set_sample(vm::Registers& registers, const Lamp& lamp) const {
    const auto planes = [&](size_t plane) {
        return planes_of(const_cast<float*>(samples_.data()) + plane * lanes_, lanes_);  // an input
    };
    const rsl::Program& program = registers.program();
    for (const auto& [name, plane] : {std::pair("P", kSampleP), {"N", kSampleN}})
        if (const rsl::RegisterId* id = program.find_global(name))
            copy_operand(planes(plane), 3, lanes_, registers.operand(*id));
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

Task<> LightRig::run(size_t light, Slot& slot, const vm::LightRequest& request,
                     std::span<const Taken> taken) {
    const Turn& turn = turns_[light];
    const Lamp& lamp = *(*lamps_)[turn.lamp];
    const vm::Operand& P = request.P;
    const BoundShader& shader = taken.empty() ? *lamp.shader : *lamp.told;
    vm::Registers& registers =
        machine_->registers(shader.executable(), taken.empty() ? light : kTold + request.depth);
    registers.start(lanes_);
    shader.set_parameters(registers, {});
    set_variables(registers, lamp, P);
    std::vector<float> times;
    if (lamp.area) {
        times = sample(turn, lamp, P);
        set_sample(registers, lamp);
    }
    give(registers, taken, request.lanes);
    std::vector<size_t> given;
    for (const Taken& one : taken) given.push_back(one.parameter);
    if (slot.capacity < lanes_) {
        slot.planes = {static_cast<float*>(std::aligned_alloc(64, kPlanes * lanes_ * sizeof(float))),
                       std::free};
        if (!slot.planes) throw std::bad_alloc();
        slot.capacity = lanes_;
    }
    float* planes = slot.planes.get();
    vm::LightOutput output;
    output.L = planes + kL * lanes_;
    output.lit = reinterpret_cast<uint32_t*>(planes + kLit * lanes_);
    if (shader.program().directional) {
        std::memset(output.L, 0, 3 * lanes_ * sizeof(float));
        std::memset(output.lit, 0, lanes_ * sizeof(float));
    }
    vm::Context context = *surroundings_;
    context.spaces = lamp.spaces.get();
    context.light_output = &output;
    context.lights = nullptr;
    context.ray_times = times;
    co_await shader.set_run_defaults(*machine_, registers, context, {}, given);
    co_await machine_->run(registers, context);
    if (lamp.area && shader.program().directional) turn_back(output.L);
    tell(turn, output, registers, slot);
}

/// What arrives of a light that has run.
void LightRig::tell(const Turn& turn, const vm::LightOutput& output, const vm::Registers& registers,
                    Slot& slot) {
    const rsl::Program& program = registers.program();
    float* const planes = slot.planes.get();
    Arriving& arriving = slot.arriving;
    arriving.ambient = !program.directional;
    arriving.distant = output.distant;
    arriving.registers = &registers;
    arriving.L = output.L;
    arriving.direction = planes + kDirection * lanes_;
    arriving.Cl = planes + kCl * lanes_;
    arriving.lit = planes + kLit * lanes_;
    arriving.diffuse = 1 - std::clamp(output_number(registers, "__nondiffuse", 0), 0.0f, 1.0f);
    arriving.specular = 1 - std::clamp(output_number(registers, "__nonspecular", 0), 0.0f, 1.0f);
    const rsl::RegisterId* Cl = program.find_global("Cl");
    const vm::Operand arrives = planes_of(planes + kCl * lanes_, lanes_);
    if (!Cl) std::fill_n(arrives.data, 3 * lanes_, 0.0f);
    const vm::Operand sent = Cl ? registers.operand(*Cl) : arrives;
    if (arriving.ambient)
        copy_operand(sent, 3, lanes_, arrives);
    else
        vm::receive_light(lanes_, planes_of(planes + kLit * lanes_, lanes_), sent,
                          planes_of(planes + kL * lanes_, lanes_),
                          planes_of(planes + kDirection * lanes_, lanes_), arrives);
    const float share = 1 / static_cast<float>(turn.samples);
    if (turn.samples > 1)
        for (size_t i = 0; i < 3 * lanes_; ++i) arrives.data[i] *= share;
}

bool LightRig::in_category(const Arriving& light, std::string_view wanted) {
    if (wanted.empty()) return true;
    const vm::Registers* own = light.registers;
    std::string_view categories;
    if (own)
        for (const rsl::ProgramParameter& parameter : own->program().parameters)
            if (parameter.name == "__category" && parameter.type.base == rsl::Base::String)
                categories = own->text(parameter.id);
    const bool excluded = wanted.front() == '-';
    if (excluded) wanted.remove_prefix(1);
    const auto has = [&](std::string_view name) {
        for (size_t at = 0; at <= categories.size();) {
            const size_t comma = std::min(categories.find(',', at), categories.size());
            if (categories.substr(at, comma - at) == name) return true;
            at = comma + 1;
        }
        return false;
    };
    bool any = false;
    for (size_t at = 0; at <= wanted.size();) {
        const size_t comma = std::min(wanted.find(',', at), wanted.size());
        any = any || has(wanted.substr(at, comma - at));
        at = comma + 1;
    }
    return any != excluded;
}

}  // namespace trapeze
