// Operations on arrays of no length in their type, whose elements are counted in a register of its own. The
// count may differ from vertex to vertex; memory is for the largest.
#include <fmt/format.h>

#include <cmath>

#include "shade/rsl/syntax/ast.h"
#include "shade/vm/context_ops.h"
#include "shade/vm/kernels/spline.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// A number of elements, or the place of one, out of a float that may be anything. More than an array may
/// have is one more, for which there is no room: who asks is told.
size_t whole(float x) {
    constexpr float kMost = rsl::kLongestArray + 1;
    return x > 0 ? static_cast<size_t>(std::min(std::floor(x), kMost)) : 0;
}

/// An operand of a step, as an array.
class Array {
  public:
    Array(Run& run, const Step& step, size_t operand)
        : registers_(run.registers()),
          id_(registers_.register_of(step, operand)),
          at_(registers_.operands_of(step)[operand]),
          type_(registers_.reg(id_).type) {}

    bool is_text() const { return type_.base == rsl::Base::String; }
    bool is_varying() const { return at_.lane_mask != 0; }
    bool grows() const { return type_.is_unsized(); }
    size_t width() const { return static_cast<size_t>(rsl::width_of(type_.base)); }
    /// Elements that there is memory for.
    size_t room() const { return grows() ? registers_.room(id_) : static_cast<size_t>(at_.length); }
    /// Where a component of an element begins; operands follow their memory as it grows.
    float* plane(size_t element, size_t component) const {
        return at_.data + element * at_.element_stride + component * at_.stride;
    }
    float& at(size_t element, size_t component, size_t lane) const {
        return plane(element, component)[lane & at_.lane_mask];
    }
    std::string& text(size_t element) const {
        return grows() ? registers_.text_array(id_)[element] : registers_.text(id_, element);
    }
    bool grow(size_t elements) const { return registers_.grow(id_, elements); }

  private:
    Registers& registers_;
    rsl::RegisterId id_;
    const Operand& at_;
    rsl::Type type_;
};

/// The lanes for which an operation does something: those that run. One lane speaks for all of what is
/// uniform.
class Lanes {
  public:
    Lanes(Run& run, bool varying)
        : running_(run.masks().current()), size_(varying ? run.lanes() : 1), varying_(varying) {
        // Lanes behind the batch's vertices may hold anything, and ask for no memory.
        vertices_ = varying && run.context().batch ? std::min(run.context().batch->vertices, size_) : size_;
        for (size_t i = 0; i < size_; ++i) all_ = all_ && is_running(i);
    }
    bool is_running(size_t lane) const { return !varying_ || running_[lane] != 0; }
    bool all() const { return all_; }
    size_t size() const { return size_; }
    /// The greatest number of elements that a function of the lane gives.
    template <class Count>
    size_t most(const Count& count) const {
        size_t most = 0;
        for (size_t i = 0; i < vertices_; ++i)
            if (is_running(i)) most = std::max<size_t>(most, count(i));
        return most;
    }

  private:
    const uint32_t* running_;
    size_t size_, vertices_;
    bool varying_, all_ = true;
};

size_t count_at(const Operand& count, size_t lane) {
    return whole(Run::at(count, 0, lane));
}

/// Texts are uniform: the first lane that runs speaks for all.
size_t first_lane(Run& run) {
    const uint32_t* running = run.masks().current();
    for (size_t i = 0; i < run.lanes(); ++i)
        if (running[i]) return i;
    return 0;
}

/// Makes room, or says that there is none.
void grow(Run& run, const Step& step, const Array& array, size_t elements) {
    if (array.grow(elements) || !run.context().diagnostics) return;
    const std::string& name = run.registers().program().name;
    run.context().diagnostics->error(
        step.at,
        fmt::format(
            "the arrays of shader \"{}\" have grown too large: together they have at most {} numbers, "
            "or {} texts; further elements are lost",
            name, rsl::kMostArrayFloats, rsl::kMostArrayFloats / 16),
        fmt::format("rsl-large-arrays {}", name));
}

/// One element for all lanes: its planes are copied as they lie.
void copy_element(Run& run, const Array& array, size_t element, const Operand& out) {
    const size_t plane = plane_size(run, out);
    for (size_t k = 0; k < array.width(); ++k) {
        if (array.is_varying() == (out.lane_mask != 0))
            std::copy_n(array.plane(element, k), plane, out.data + k * out.stride);
        else
            std::fill_n(out.data + k * out.stride, plane, array.at(element, k, 0));
    }
}

/// array[index], clamped to the elements that there are; 0 where there are none.
void array_element(Run& run, const Step& step, std::span<const Operand> operands) {
    const Operand &out = operands[0], &count = operands[2], &index = operands[3];
    const Array array(run, step, 1);
    const auto place = [&](size_t lane, size_t elements) {
        return std::min(whole(Run::at(index, 0, lane)), elements - 1);
    };
    const auto elements_at = [&](size_t lane) { return std::min(count_at(count, lane), array.room()); };
    if (array.is_text()) {
        const size_t lane = first_lane(run), elements = elements_at(lane);
        const std::string text = elements ? array.text(place(lane, elements)) : std::string();
        run.registers().text(run.registers().register_of(step, 0)) = text;
        return;
    }
    if (!(count.lane_mask | index.lane_mask)) {
        if (const size_t elements = elements_at(0)) return copy_element(run, array, place(0, elements), out);
        constexpr float kZeros[16] = {};
        return fill_operand(run, out, std::span(kZeros, array.width()));
    }
    for (size_t i = 0; i < plane_size(run, out); ++i) {
        const size_t elements = elements_at(i);
        const size_t at = elements ? place(i, elements) : 0;
        for (size_t k = 0; k < array.width(); ++k)
            out.data[k * out.stride + i] = elements ? array.at(at, k, i) : 0.0f;
    }
}

/// Sets one element in a lane; there is room for it.
void set_lane(const Array& array, size_t element, const Operand& value, size_t lane) {
    for (size_t k = 0; k < array.width(); ++k) {
        const float x = Run::at(value, static_cast<int>(k), lane);
        if (array.is_varying())
            array.at(element, k, lane) = x;
        else
            std::fill_n(array.plane(element, k), kLanes, x);
    }
}

/// array[index] = value, clamped likewise; nothing where there are no elements.
void set_array_element(Run& run, const Step& step, std::span<const Operand> operands) {
    const Operand &count = operands[1], &index = operands[2], &value = operands[3];
    const Array array(run, step, 0);
    if (array.is_text()) {
        const size_t lane = first_lane(run), elements = std::min(count_at(count, lane), array.room());
        if (elements)
            array.text(std::min(whole(Run::at(index, 0, lane)), elements - 1)) =
                run.registers().text_input(step, 2);
        return;
    }
    const Lanes lanes(run, array.is_varying());
    for (size_t i = 0; i < lanes.size(); ++i) {
        const size_t elements = std::min(count_at(count, i), array.room());
        if (lanes.is_running(i) && elements)
            set_lane(array, std::min(whole(Run::at(index, 0, i)), elements - 1), value, i);
    }
}

/// The element behind the last; the count is another instruction's to raise.
void push_element(Run& run, const Step& step, std::span<const Operand> operands) {
    const Operand &count = operands[1], &value = operands[2];
    const Array array(run, step, 0);
    const auto longer = [&](size_t lane) { return count_at(count, lane) + 1; };
    if (array.is_text()) {
        const size_t elements = longer(first_lane(run));
        grow(run, step, array, elements);
        if (elements <= array.room()) array.text(elements - 1) = run.registers().text_input(step, 1);
        return;
    }
    const Lanes lanes(run, array.is_varying());
    grow(run, step, array, lanes.most(longer));
    for (size_t i = 0; i < lanes.size(); ++i)
        if (lanes.is_running(i) && longer(i) <= array.room()) set_lane(array, longer(i) - 1, value, i);
}

/// Elements that come in addition are 0, or empty texts.
void resize_array(Run& run, const Step& step, std::span<const Operand> operands) {
    const Operand &before = operands[1], &behind = operands[2];
    const Array array(run, step, 0);
    const auto wanted = [&](size_t lane) { return count_at(behind, lane); };
    if (array.is_text()) {
        const size_t lane = first_lane(run);
        grow(run, step, array, wanted(lane));
        for (size_t e = count_at(before, lane); e < std::min(wanted(lane), array.room()); ++e)
            array.text(e).clear();
        return;
    }
    const Lanes lanes(run, array.is_varying());
    const size_t most = lanes.most(wanted);
    grow(run, step, array, most);
    run.count_elements(most);
    constexpr float kZero = 0;
    const Operand zero{.data = const_cast<float*>(&kZero), .lane_mask = 0, .stride = 0};
    for (size_t i = 0; i < lanes.size(); ++i)
        for (size_t e = count_at(before, i); e < std::min(wanted(i), array.room()); ++e)
            if (lanes.is_running(i)) set_lane(array, e, zero, i);
}

/// A whole array, of which lanes that do not run keep what they have.
void copy_array(Run& run, const Step& step, std::span<const Operand> operands) {
    const Operand& count = operands[2];
    const Array to(run, step, 0), from(run, step, 1);
    const auto elements_at = [&](size_t lane) { return std::min(count_at(count, lane), from.room()); };
    if (to.is_text()) {
        const size_t elements = elements_at(first_lane(run));
        if (to.grows()) grow(run, step, to, elements);
        for (size_t e = 0; e < std::min(elements, to.room()); ++e) to.text(e) = from.text(e);
        return;
    }
    const Lanes lanes(run, to.is_varying());
    const size_t most = lanes.most(elements_at);
    if (to.grows()) grow(run, step, to, most);
    run.count_elements(most);
    const size_t plane = to.is_varying() ? run.lanes() : kLanes;
    for (size_t e = 0; e < std::min(most, to.room()); ++e)
        for (size_t k = 0; k < to.width(); ++k) {
            if (lanes.all() && to.is_varying() == from.is_varying())
                std::copy_n(from.plane(e, k), plane, to.plane(e, k));
            else
                for (size_t i = 0; i < plane; ++i)
                    if (lanes.is_running(i)) to.plane(e, k)[i] = from.at(e, k, i);
        }
}

/// spline() of an array: the kernel takes it as one of so many elements, and is called for each number of
/// them that a lane has.
void array_spline(Run& run, const Step& step, std::span<const Operand> operands) {
    const Operand &out = operands[0], &count = operands[4];
    const std::string& name = run.registers().text_input(step, 0);
    const Array array(run, step, 3);
    const int width = static_cast<int>(array.width());
    const Kernel kernel = spline_or_usual(run, step, name, width);
    if (!kernel) return;
    const size_t plane = plane_size(run, out), lanes = count.lane_mask ? plane : 1;
    Operand knots = operands[3], result = out;
    result.data = run.scratch(static_cast<size_t>(width));
    result.stride = width > 1 ? plane : 0;
    std::vector<bool> done(lanes, false);
    for (size_t i = 0; i < lanes; ++i) {
        if (done[i]) continue;
        const size_t elements = std::min(count_at(count, i), array.room());
        // An array of no elements gives 0, as one of too few does.
        knots.length = std::max(static_cast<int>(elements), 1);
        kernel(plane, std::array{result, operands[2], knots});
        for (size_t j = 0; j < plane; ++j) {
            const bool same = std::min(count_at(count, j), array.room()) == elements;
            if (same && j < lanes) done[j] = true;
            for (size_t k = 0; same && k < array.width(); ++k)
                out.data[k * out.stride + j] = result.data[k * result.stride + j];
        }
    }
}

constexpr ContextRow kArrayRows[] = {
    {Op::ArrayElement, array_element}, {Op::SetArrayElement, set_array_element},
    {Op::PushElement, push_element},   {Op::ResizeArray, resize_array},
    {Op::CopyArray, copy_array},       {Op::ArraySpline, array_spline},
};

}  // namespace

ContextOp find_array_op(Op op) {
    return context_op_in(kArrayRows, op);
}

}  // namespace trapeze::vm
