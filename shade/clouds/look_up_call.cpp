#include "shade/clouds/look_up_call.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "shade/vm/context_ops.h"

namespace trapeze {
namespace {

using vm::Operand;
using vm::Run;
using vm::Step;

/// Inputs of the call; behind P and N the names of the outputs.
enum LookUpInput : size_t { kLookUpFile, kLookUpP, kLookUpN, kLookUpNamed };

/// Sets a lane's value, or that of all lanes where it is uniform.
void put(const Operand& out, size_t component, size_t lane, float value) {
    float* const plane = out.data + component * out.stride;
    if (out.lane_mask)
        plane[lane] = value;
    else
        std::fill_n(plane, kLanes, value);
}

}  // namespace

LookUpCall::LookUpCall(Run& run, const Step& step, std::span<const Operand> operands, CloudLibrary* library)
    : run_(run),
      step_(step),
      operands_(operands),
      P_(&operands[step.outputs + kLookUpP]),
      N_(&operands[step.outputs + kLookUpN]) {
    if (library) cloud_ = library->find(run.registers().text_input(step, kLookUpFile), step.at);
    if (!cloud_) return;
    const size_t named = step.outputs - size_t{1};
    find_outputs(named);
    set_space("world");
    for (size_t i = step.outputs + kLookUpNamed + named; i + 1 < step.count; i += 2) take_named(i);
}

void LookUpCall::find_outputs(size_t named) {
    const vm::Registers& registers = run_.registers();
    for (size_t k = 0; k < named; ++k) {
        const std::string& name = registers.text_input(step_, kLookUpNamed + k);
        const int width = rsl::width_of(registers.reg(registers.register_of(step_, 1 + k)).type.base);
        size_t first = 0;
        const CloudChannel* const channel = cloud_->find(name, &first);
        if (channel && floats_of(channel->type) == width)
            outputs_.push_back({&operands_[1 + k], channel->type, first});
        else
            run_.warn(
                step_,
                fmt::format("texture3d: \"{}\" has no channel \"{}\" of {} number{}",
                            registers.text_input(step_, kLookUpFile), name, width, width == 1 ? "" : "s"),
                "texture3d-channel " + name);
    }
}

/// A name and a value, operands i and i + 1. "maxdepth" and "lerp" are of brick maps alone.
void LookUpCall::take_named(size_t i) {
    const vm::Registers& registers = run_.registers();
    const std::string& name = registers.text(registers.register_of(step_, i));
    const rsl::RegisterId id = registers.register_of(step_, i + 1);
    const rsl::Type type = registers.reg(id).type;
    if (type.is_array()) return;
    if (type.base == rsl::Base::String && name == "coordsystem") set_space(registers.text(id));
    if (type.base == rsl::Base::Float && name == "filterradius") radius_ = &operands_[i + 1];
    if (type.base == rsl::Base::Float && name == "filterscale") scale_ = &operands_[i + 1];
}

void LookUpCall::set_space(const std::string& space) {
    moved_ = false;
    if (!run_.context().spaces || space == "current") return;
    const auto to = run_.context().spaces->matrix("current", space);
    if (!to)
        return run_.warn(step_, fmt::format("texture3d: there is no coordinate system \"{}\"", space),
                         "texture3d-space " + space);
    moved_ = true;
    const M44d exact(*to);
    to_space_ = *to, from_space_ = M44f(exact.inverse());
    normals_to_space_ = M44f(exact.inverse().transposed()), normals_from_space_ = M44f(exact.transposed());
}

/// A value of the cloud's space in the current one.
V3f LookUpCall::back(ChannelType type, const V3f& value) const {
    V3f result = value;
    if (!moved_) return result;
    if (type == ChannelType::Point) from_space_.multVecMatrix(value, result);
    if (type == ChannelType::Vector) from_space_.multDirMatrix(value, result);
    if (type == ChannelType::Normal) normals_from_space_.multDirMatrix(value, result);
    return result;
}

/// Sets the variables of a lane to means over the points.
void LookUpCall::set(size_t lane, const std::vector<CloudShare>& shares) const {
    const size_t stride = cloud_->cloud.floats_per_point();
    for (const Output& output : outputs_) {
        const size_t floats = static_cast<size_t>(floats_of(output.type));
        V3f mean;
        for (size_t k = 0; k < floats && k < 3; ++k) {
            double sum = 0;
            for (const CloudShare& share : shares)
                sum += share.weight *
                       static_cast<double>(cloud_->cloud.values[share.point * stride + output.first + k]);
            mean[static_cast<int>(k)] = static_cast<float>(sum);
        }
        mean = back(output.type, mean);
        for (size_t k = 0; k < floats && k < 3; ++k) put(*output.operand, k, lane, mean[static_cast<int>(k)]);
    }
}

void LookUpCall::run(std::vector<CloudShare>& shares) const {
    vm::fill_operand(run_, operands_[0], std::array{0.0f});
    if (!cloud_) return;
    const bool varies = std::ranges::any_of(operands_.first(step_.outputs),
                                            [](const Operand& out) { return out.lane_mask != 0; });
    const vm::Batch* const batch = run_.context().batch;
    const size_t lanes = varies ? batch ? batch->vertices : run_.lanes() : 1;
    for (size_t lane = 0; lane < lanes; ++lane) {
        if (varies && !run_.masks().all() && !run_.masks().current()[lane]) continue;
        CloudPlace place;
        place.position = vm::Run::triple_at(*P_, lane), place.normal = vm::Run::triple_at(*N_, lane);
        if (moved_) {
            to_space_.multVecMatrix(V3f(place.position), place.position);
            normals_to_space_.multDirMatrix(V3f(place.normal), place.normal);
        }
        place.normal.normalize();
        if (radius_) place.radius = Run::at(*radius_, 0, lane);
        if (scale_) place.radius_scale = Run::at(*scale_, 0, lane);
        cloud_->tree.find(place, shares);
        if (shares.empty()) continue;
        put(operands_[0], 0, lane, 1);
        set(lane, shares);
    }
}

}  // namespace trapeze
