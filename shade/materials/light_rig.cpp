#include "shade/materials/light_rig.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

#include "core/scene/scene.h"
#include "shade/vm/kernels/light_kernels.h"

namespace trapeze {
namespace {

/// A light's planes in a Slot, by number: L, its direction and Cl have three planes each, the mask of lit
/// lanes one.
constexpr size_t kL = 0, kDirection = 3, kCl = 6, kLit = 9, kPlanes = 10;

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

}  // namespace

void LightRig::start(vm::Machine& machine, const std::vector<const Lamp*>& lamps,
                     const vm::Context& surroundings, size_t lanes, const Plane3& N) {
    machine_ = &machine;
    lamps_ = &lamps;
    surroundings_ = &surroundings;
    lanes_ = lanes;
    N_ = N;
    while (slots_.size() < lamps.size()) slots_.emplace_back();
    for (Slot& slot : slots_) {
        slot.lasts = false;
        slot.arriving.registers = nullptr;
    }
}

const vm::Lights::Arriving& LightRig::arriving(size_t light, const vm::Operand& P, bool lasting) {
    Slot& slot = slots_[light];
    if (lasting && slot.lasts) return slot.arriving;
    run(light, slot, P);
    slot.lasts = lasting;
    return slot.arriving;
}

const vm::Registers* LightRig::registers(size_t light) const {
    return light < count() ? slots_[light].arriving.registers : nullptr;
}

void LightRig::set_variables(vm::Registers& registers, const Lamp& lamp, const vm::Operand& P) const {
    using vm::Predefined;
    for (const vm::StartValue& value : registers.executable().start_values()) {
        const rsl::RegisterId id = value.id;
        const vm::Operand& operand = registers.operand(id);
        const Predefined variable = value.variable;
        if (variable == Predefined::Ps || variable == Predefined::I) {  // the eye is at the origin
            copy_operand(P, 3, lanes_, operand);
        } else if (variable == Predefined::P) {
            registers.set_uniform(id, &lamp.position.x);
        } else if ((variable == Predefined::N || variable == Predefined::Ns) && N_.size() == lanes_) {
            for (int k = 0; k < 3; ++k)
                std::memcpy(operand.data + static_cast<size_t>(k) * operand.stride, N_[k].data(),
                            lanes_ * sizeof(float));
        } else if (rsl::width_of(registers.reg(id).type.base) > 0) {
            const float zeros[16] = {};
            registers.set_uniform(id, zeros);
        }
    }
}

void LightRig::run(size_t light, Slot& slot, const vm::Operand& P) {
    const Lamp& lamp = *(*lamps_)[light];
    const rsl::Program& program = lamp.shader->program();
    vm::Registers& registers = machine_->registers(lamp.shader->executable(), light);
    registers.start(lanes_);
    lamp.shader->set_parameters(registers, {});
    set_variables(registers, lamp, P);
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
    if (program.directional) {
        std::memset(output.L, 0, 3 * lanes_ * sizeof(float));
        std::memset(output.lit, 0, lanes_ * sizeof(float));
    }
    vm::Context context = *surroundings_;
    context.spaces = lamp.spaces.get();
    context.light_output = &output;
    context.lights = nullptr;
    lamp.shader->set_run_defaults(*machine_, registers, context, {});
    machine_->run(registers, context);

    Arriving& arriving = slot.arriving;
    arriving.ambient = !program.directional;
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
}

bool LightRig::in_category(size_t light, std::string_view wanted) {
    if (wanted.empty()) return true;
    const vm::Registers* own = registers(light);
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
