#include "shade/rays/sent_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "shade/operations/ray_parameters.h"

namespace trapeze {
namespace {

using rsl::Base;

std::optional<ValueType> value_type(Base base) {
    switch (base) {
        case Base::Float:
            return ValueType::Float;
        case Base::Color:
            return ValueType::Color;
        case Base::Point:
            return ValueType::Point;
        case Base::Vector:
            return ValueType::Vector;
        case Base::Normal:
            return ValueType::Normal;
        case Base::Matrix:
            return ValueType::Matrix;
        case Base::String:
            return ValueType::String;
        default:
            return {};
    }
}

}  // namespace

bool SentValues::add(vm::Run& run, const vm::Step& step, size_t operand,
                     std::span<const vm::Operand> operands) {
    const vm::Registers& registers = run.registers();
    const std::string& text = registers.text(registers.register_of(step, operand));
    const std::optional<rsl::SentName> name = rsl::sent_name(text);
    if (!name) return false;
    const rsl::RegisterId id = registers.register_of(step, operand + 1);
    const rsl::Type type = registers.reg(id).type;
    const std::optional<ValueType> sent_type = value_type(type.base);
    if (!sent_type || type.is_unsized()) {  // of a name that is known in the run alone
        run.warn(step,
                 fmt::format("\"{}\" of gather is ignored: {} are not sent", text,
                             sent_type ? "arrays that grow" : "comparisons"),
                 "rsl-send-type " + text);
        return true;
    }
    SentVariable& sent = variables_.emplace_back();
    sent.to = name->to, sent.at = step.at;
    sent.variable.name = name->name, sent.variable.uniform = true;
    const bool is_text = type.base == Base::String;
    const size_t elements = static_cast<size_t>(std::max(type.length, 1));
    sent.variable.declaration = {StorageClass::Uniform, *sent_type, static_cast<int>(elements)};
    const vm::Operand& value = operands[operand + 1];
    for (size_t e = 0; e < elements; ++e) {
        if (is_text) sent.variable.strings.push_back(registers.text(id, e));
        for (size_t k = 0; k < static_cast<size_t>(rsl::width_of(type.base)); ++k) {
            sent.variable.planes.push_back({0.0f});
            planes_.push_back({value.data + e * value.element_stride + k * value.stride, value.lane_mask});
        }
    }
    return true;
}

void SentValues::append(size_t lane, std::vector<float>& numbers) const {
    for (const Plane& plane : planes_) numbers.push_back(plane.data[lane & plane.lane_mask]);
}

}  // namespace trapeze
