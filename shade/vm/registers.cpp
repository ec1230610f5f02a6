#include "shade/vm/registers.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <new>

namespace trapeze::vm {

void Registers::Free::operator()(float* p) const {
    std::free(p);
}

/// Operands are made anew only where the number of lanes changes. One block of memory holds all planes: the
/// uniform ones first, kLanes floats each, then the varying ones, `lanes` floats each. Memory only grows.
/// When fewer lanes are asked for, planes move closer together in the same block and hold what other planes
/// left there, which is why contents count as undefined.
void Registers::start(size_t lanes) {
    if (executable_->text_count()) texts_ = executable_->texts();
    if (lanes == lanes_) return;
    lanes_ = lanes;
    const size_t uniform = executable_->uniform_planes() * kLanes;
    if (lanes > capacity_ || !memory_) {
        capacity_ = lanes;
        const size_t floats = uniform + executable_->varying_planes() * lanes + kLanes;
        memory_.reset(static_cast<float*>(std::aligned_alloc(64, floats * sizeof(float))));
        if (!memory_) throw std::bad_alloc();
        // Lanes that no instruction has set are zero, not what another program left.
        std::fill_n(memory_.get(), floats, 0.0f);
    }
    const std::vector<Place>& places = executable_->places();
    by_id_.resize(places.size());
    for (size_t id = 0; id < places.size(); ++id) {
        Operand& operand = by_id_[id];
        const rsl::Type type = program().registers[id].type;
        const int width = rsl::width_of(type.base);
        const bool varying = places[id].kind == Place::Kind::Varying;
        const size_t plane = varying ? lanes : kLanes;
        if (places[id].kind == Place::Kind::Constant)
            operand.data =
                const_cast<float*>(executable_->constants()) + places[id].at * kLanes;  // read only
        else if (varying)
            operand.data = memory_.get() + uniform + places[id].at * lanes;
        else
            operand.data = memory_.get() + places[id].at * kLanes;
        operand.lane_mask = varying ? ~size_t{0} : 0;
        operand.stride = width > 1 ? plane : 0;
        operand.element_stride = static_cast<size_t>(width) * plane;
        operand.length = type.length;
    }
    operands_.clear();
    for (const rsl::RegisterId id : executable_->operands()) operands_.push_back(by_id_[id]);
}

/// An element of an array is chosen by its number; 0 for what is no array. A varying register gets the value
/// in all lanes, a uniform one in its one group of lanes, from which kernels load as from any plane.
void Registers::set_uniform(rsl::RegisterId id, const float* values, size_t element) {
    const Operand& operand = by_id_[id];
    const int width = rsl::width_of(reg(id).type.base);
    const size_t plane = operand.lane_mask ? lanes_ : kLanes;
    for (int k = 0; k < width; ++k) {
        float* out = operand.data + element * operand.element_stride + static_cast<size_t>(k) * plane;
        if (std::bit_cast<uint32_t>(values[k]) == 0)
            std::memset(out, 0, plane * sizeof(float));  // the most frequent value, and faster so
        else
            std::fill_n(out, plane, values[k]);
    }
}

}  // namespace trapeze::vm
