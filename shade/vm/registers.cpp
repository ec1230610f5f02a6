#include "shade/vm/registers.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <new>

#include "shade/rsl/syntax/ast.h"

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
    if (lanes == lanes_) return start_growing();
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
        if (places[id].growing != Place::kNone) operand.data = nullptr;  // start_growing()
    }
    operands_.clear();
    for (const rsl::RegisterId id : executable_->operands()) operands_.push_back(by_id_[id]);
    start_growing();
}

/// Each array that grows begins with room for one element, so that what knows nothing of such arrays finds a
/// value. Memory is given back once more is kept than a run may have.
void Registers::start_growing() {
    const std::vector<rsl::RegisterId>& ids = executable_->growing();
    if (ids.empty()) return;
    if (growing_.empty()) {
        growing_.resize(ids.size());
        const std::vector<rsl::RegisterId>& operands = executable_->operands();
        for (uint32_t i = 0; i < operands.size(); ++i)
            if (const uint32_t number = executable_->places()[operands[i]].growing; number != Place::kNone)
                growing_[number].uses.push_back(i);
    }
    size_t kept = 0;
    for (const Growing& array : growing_) kept += array.floats;
    const bool keep = kept <= size_t{rsl::kMostArrayFloats} * lanes_;
    grown_ = 0;
    for (size_t i = 0; i < ids.size(); ++i) {
        Growing& array = growing_[i];
        if (!keep) array.memory.reset(), array.floats = 0;
        array.elements = 0;
        array.texts.clear();
        grow(ids[i], 1);
    }
}

/// Grows by halves more at least, so that elements pushed one by one are moved seldom. An element's planes
/// lie behind those of the one before it, so that what there is moves as one piece.
bool Registers::grow(rsl::RegisterId id, size_t elements) {
    // A text counts for as much as the memory that most texts need.
    constexpr size_t kFloatsOfText = 16;
    Growing& array = growing_[executable_->places()[id].growing];
    if (elements <= array.elements) return true;
    const Operand& operand = by_id_[id];
    const size_t width = static_cast<size_t>(rsl::width_of(reg(id).type.base));
    const size_t one = width ? width : kFloatsOfText;
    const size_t others = grown_ - array.elements * one, most = rsl::kMostArrayFloats;
    if (others + elements * one > most) return false;
    if (elements > 1) elements = std::min(std::max(elements, array.elements * 3 / 2), (most - others) / one);
    grown_ = others + elements * one;
    const size_t before = array.elements * operand.element_stride;
    array.elements = elements;
    if (!width) {
        array.texts.resize(elements);
        return true;
    }
    const size_t floats = elements * operand.element_stride;
    if (floats > array.floats) {
        std::unique_ptr<float, Free> memory(
            static_cast<float*>(std::aligned_alloc(64, floats * sizeof(float))));
        if (!memory) throw std::bad_alloc();
        if (before) std::memcpy(memory.get(), array.memory.get(), before * sizeof(float));
        std::fill(memory.get() + before, memory.get() + floats, 0.0f);
        array.memory = std::move(memory), array.floats = floats;
    }
    by_id_[id].data = array.memory.get();
    for (const uint32_t use : array.uses) operands_[use].data = array.memory.get();
    return true;
}

size_t Registers::set_count(rsl::RegisterId id, size_t elements) {
    if (!grow(id, elements)) elements = 0;
    const float count = static_cast<float>(elements);
    set_uniform(reg(id).count, &count);
    return elements;
}

size_t Registers::count(rsl::RegisterId id) const {
    const float count = by_id_[reg(id).count].data[0];
    return count > 0 ? std::min(static_cast<size_t>(count), room(id)) : 0;
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
