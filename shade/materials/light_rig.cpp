#include "shade/materials/light_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

#include "core/random.h"
#include "core/scene/scene.h"
#include "core/scene/shading_grid.h"
#include "shade/lights/light_categories.h"
#include "shade/materials/copy_operand.h"
#include "shade/vm/kernels/light_kernels.h"

namespace trapeze {
namespace {

/// A light's planes in a Slot, by number: L, its direction and Cl have three planes each, the mask of lit
/// lanes one.
constexpr size_t kL = 0, kDirection = 3, kCl = 6, kLit = 9, kPlanes = 10;

/// The value of an output parameter, a float, at the first vertex; `fallback` when there is none.
float output_number(const vm::Registers& registers, std::string_view name, float fallback) {
    for (const rsl::ProgramParameter& parameter : registers.program().parameters)
        if (parameter.name == name && parameter.type == rsl::Type{rsl::Base::Float, 0})
            return registers.operand(parameter.id).data[0];
    return fallback;
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

}  // namespace

void LightRig::start(vm::Machine& machine, const std::vector<const Lamp*>& lamps,
                     const std::vector<const Lamp*>& all, const vm::Context& surroundings, size_t lanes,
                     const Plane3& N, uint32_t seed, std::span<const M44f> held) {
    machine_ = &machine;
    lamps_ = &lamps;
    surroundings_ = &surroundings;
    lanes_ = lanes;
    N_ = N;
    turns_.clear();
    int wanted = 0;
    for (const Lamp* lamp : all) wanted += lamp->turns();
    for (uint32_t i = 0; i < lamps.size(); ++i) {
        const int asked = lamps[i]->turns();
        const int samples =
            wanted > kMostTurns && asked > 1 ? std::max(1, asked * kMostTurns / wanted) : asked;
        const auto number = static_cast<uint32_t>(std::ranges::find(all, lamps[i]) - all.begin());
        for (int s = 0; s < samples; ++s) turns_.push_back({i, number, s, samples});
    }
    if (std::ranges::any_of(lamps, [](const Lamp* lamp) { return lamp->area != nullptr; }))
        samples_.start(surroundings, lanes, N, seed, held);
    while (slots_.size() < turns_.size()) slots_.emplace_back();
    for (Slot& slot : slots_) {
        slot.lasts = false;
        slot.arriving.registers = nullptr;
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

/// What is the same for all points.
std::optional<float> LightRig::number_of(vm::Predefined variable) const {
    using vm::Predefined;
    if (variable == Predefined::time) return surroundings_->shutter_open;
    if (variable == Predefined::dtime) return surroundings_->shutter_close - surroundings_->shutter_open;
    if (variable == Predefined::ncomps) return 3.0f;
    return {};
}

/// Parameters of the surface that is lit, and how far they change over what a vertex stands for: what
/// patterns in lights are filtered by.
std::optional<vm::Operand> LightRig::footprint_plane(vm::Predefined variable) const {
    using vm::Predefined;
    const bool is_parameter = variable == Predefined::SurfaceU || variable == Predefined::SurfaceV;
    if (!is_parameter && variable != Predefined::du && variable != Predefined::dv) return {};
    if (!surroundings_->footprints) return {};
    const vm::Footprint& at = surroundings_->footprints->get();
    if (is_parameter) return variable == Predefined::SurfaceU ? at.u : at.v;
    return planes_of(const_cast<float*>(variable == Predefined::du ? at.du : at.dv), lanes_);  // an input
}

/// Whether AreaSamples::tell() sets it for every light with an area.
bool LightRig::is_of_sample(vm::Predefined variable) {
    using vm::Predefined;
    return variable == Predefined::P || variable == Predefined::N || variable == Predefined::Ng;
}

void LightRig::set_variables(vm::Registers& registers, const Lamp& lamp, const vm::Operand& P) const {
    using vm::Predefined;
    for (const vm::StartValue& value : registers.executable().start_values()) {
        const rsl::RegisterId id = value.id;
        const vm::Operand& operand = registers.operand(id);
        const Predefined variable = value.variable;
        if (lamp.area && is_of_sample(variable)) {
            continue;                                                          // AreaSamples::tell()
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
        } else if (const std::optional<float> number = number_of(variable)) {
            registers.set_uniform(id, &*number);
        } else if (const std::optional<vm::Operand> plane = footprint_plane(variable)) {
            copy_operand(*plane, 1, lanes_, operand);
        } else if (rsl::width_of(registers.reg(id).type.base) > 0) {
            const float zeros[16] = {};
            registers.set_uniform(id, zeros);
        }
    }
}

/// Of the rays that have hit the points which are lit: where they began, or the `way` from there to P. The
/// camera's begin in the eye, or on the eye's plane.
void LightRig::set_ray(const vm::Operand& out, bool way, const vm::Operand& P) const {
    const auto put = [&](size_t lane, const ShadingGrid* grid, size_t vertex) {
        const V3f here = vm::Run::triple_at(P, lane);
        V3f origin = here - eye_way(*surroundings_, here);
        if (grid && vertex < grid->I.size()) origin = grid->P.front().at(vertex) - grid->I.at(vertex);
        for (int k = 0; k < 3; ++k)
            out.data[static_cast<size_t>(k) * out.stride + lane] = way ? here[k] - origin[k] : origin[k];
    };
    for (size_t lane = 0; lane < lanes_; ++lane) put(lane, nullptr, 0);
    if (!surroundings_->batch) return;
    for (const vm::GridSpan& span : surroundings_->batch->spans)
        for (size_t i = 0; span.grid && i < span.grid->I.size(); ++i) put(span.first + i, span.grid, i);
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
        times = samples_.take(turn, lamp, P);
        samples_.tell(lamp, registers);
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
    if (const LightSampler* const at_open = lamp.sampler_at(0))
        context.light_roughness = at_open->roughness();
    co_await shader.set_run_defaults(*machine_, registers, context, {}, given);
    co_await machine_->run(registers, context);
    if (lamp.area && shader.program().directional) samples_.turn_back(output.L);
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
    arriving.word = hash(turn.number, static_cast<uint32_t>(turn.sample));
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
    if (arriving.ambient) {
        copy_operand(sent, 3, lanes_, arrives);
        std::fill_n(output.L, 3 * lanes_, 0.0f);
        std::memset(planes + kLit * lanes_, 0xff, lanes_ * sizeof(float));
    } else {
        vm::receive_light(lanes_, planes_of(planes + kLit * lanes_, lanes_), sent,
                          planes_of(planes + kL * lanes_, lanes_),
                          planes_of(planes + kDirection * lanes_, lanes_), arrives);
    }
    const float share = 1 / static_cast<float>(turn.samples);
    if (turn.samples > 1)
        for (size_t i = 0; i < 3 * lanes_; ++i) arrives.data[i] *= share;
}

bool LightRig::in_category(const Arriving& light, std::string_view wanted) {
    if (wanted.empty()) return true;
    LightCategories categories{{}, light.ambient, light.diffuse > 0, light.specular > 0};
    if (const vm::Registers* const own = light.registers)
        for (const rsl::ProgramParameter& parameter : own->program().parameters)
            if (parameter.name == "__category" && parameter.type.base == rsl::Base::String)
                categories.named = own->text(parameter.id);
    return categories.fit(wanted);
}

bool LightRig::in_loop(const Arriving& light, std::string_view wanted) {
    return (!light.ambient || names_ambient(wanted)) && in_category(light, wanted);
}

}  // namespace trapeze
