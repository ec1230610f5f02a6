#include "shade/vm/mask_stack.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

namespace trapeze::vm {
namespace {

/// A lane of a Bool, which kernels keep as a float.
uint32_t bits(const float* plane, size_t i) {
    uint32_t value;
    std::memcpy(&value, plane + i, sizeof value);
    return value;
}

}  // namespace

/// Planes come from aligned_alloc().
void MaskStack::Free::operator()(uint32_t* p) const {
    std::free(p);
}

/// Planes are kept from run to run, as long as no run has more lanes than those before. All planes are free
/// again, whatever a run that was broken off has left.
void MaskStack::start(size_t lanes) {
    if (lanes > capacity_) {
        planes_.clear();
        capacity_ = lanes;
    }
    lanes_ = lanes;
    blocks_.clear();
    free_.clear();
    for (const auto& plane : planes_) free_.push_back(plane.get());
    current_ = take();
    std::fill_n(current_, lanes_, ~0u);
    state_ = State::All;
}

/// The number of planes in use is the nesting depth of blocks (two for a loop), so that a run soon allocates
/// none.
uint32_t* MaskStack::take() {
    if (free_.empty()) {
        planes_.emplace_back(static_cast<uint32_t*>(std::aligned_alloc(64, capacity_ * sizeof(uint32_t))));
        if (!planes_.back()) throw std::bad_alloc();
        return planes_.back().get();
    }
    uint32_t* plane = free_.back();
    free_.pop_back();
    return plane;
}

void MaskStack::copy(const uint32_t* from, uint32_t* to) const {
    std::memcpy(to, from, lanes_ * sizeof *to);
}

/// The state decides how steps are done (all lanes: in place; none: not at all), and so is found once for
/// each change of the mask and not for each step.
void MaskStack::set_state() {
    uint32_t any = 0, every = ~0u;
    for (size_t i = 0; i < lanes_; ++i) any |= current_[i], every &= current_[i];
    state_ = !any ? State::None : every == ~0u ? State::All : State::Some;
}

/// After a jump of all lanes that ran: nothing runs until a block that holds others ends, turns to its Else
/// or begins its next turn.
void MaskStack::run_none() {
    std::fill_n(current_, lanes_, 0u);
    state_ = State::None;
}

/// Opens a block; the lanes that run now run on behind it.
MaskStack::EnteredBlock& MaskStack::push(Kind kind) {
    EnteredBlock& block = blocks_.emplace_back();
    block.kind = kind;
    block.before = take();
    copy(current_, block.before);
    return block;
}

/// Those are the lanes that jump: a jump is made by all lanes that run where it stands.
void MaskStack::take_off(uint32_t* plane) const {
    for (size_t i = 0; i < lanes_; ++i) plane[i] &= ~current_[i];
}

/// A condition is all bits or none in each lane, so that And with it keeps or clears the lane.
void MaskStack::enter_if(const float* condition) {
    push(Kind::If);
    for (size_t i = 0; i < lanes_; ++i) current_[i] &= bits(condition, i);
    set_state();
}

/// Lanes that were taken off `before` in the first half, because they jumped further out, do not run the
/// second.
void MaskStack::turn_to_else(const float* condition) {
    const uint32_t* before = blocks_.back().before;
    for (size_t i = 0; i < lanes_; ++i) current_[i] = before[i] & ~bits(condition, i);
    set_state();
}

/// The state is found anew: lanes may have left blocks further out meanwhile.
void MaskStack::leave_block() {
    EnteredBlock& block = blocks_.back();
    copy(block.before, current_);
    give_back(block.before);
    if (block.live) give_back(block.live);
    blocks_.pop_back();
    set_state();
}

/// Live lanes are those that have not left the loop for good; those of the current mask may be fewer, until
/// the next turn.
void MaskStack::enter_loop() {
    EnteredBlock& block = push(Kind::Loop);
    block.live = take();
    copy(current_, block.live);
}

void MaskStack::test_loop(const float* condition) {
    uint32_t* live = blocks_.back().live;
    for (size_t i = 0; i < lanes_; ++i) {
        // A lane that continued has not met the test in this turn, and one that left is not live.
        current_[i] &= bits(condition, i);
        live[i] &= current_[i];
    }
    set_state();
}

/// Lanes that met a Continue of this loop are still among its live ones (continue_loop()), and so run again.
void MaskStack::next_turn() {
    copy(blocks_.back().live, current_);
    set_state();
}

/// Illuminance and gather have no test: their turns are counted elsewhere, and only choose among the lanes
/// that have not left the loop.
void MaskStack::start_turn(const float* lanes) {
    const uint32_t* live = blocks_.back().live;
    for (size_t i = 0; i < lanes_; ++i) current_[i] = live[i] & bits(lanes, i);
    set_state();
}

bool MaskStack::loop_is_over() const {
    const uint32_t* live = blocks_.back().live;
    return std::all_of(live, live + lanes_, [](uint32_t lane) { return lane == 0; });
}

void MaskStack::enter_scope() {
    push(Kind::Scope);
}

/// Walks outward over the blocks that the lanes jump out of. An If or Scope on the way must not wake them at
/// its end, so they are taken off what goes on behind it; the last loop they leave keeps them there, for that
/// is where they go on.
void MaskStack::break_loops(int levels) {
    for (size_t i = blocks_.size(); i-- > 0;) {
        EnteredBlock& block = blocks_[i];
        if (block.live) take_off(block.live);
        if (block.kind == Kind::Loop && --levels <= 0) break;
        take_off(block.before);
    }
    run_none();
}

/// Takes lanes out of the loops as break_loops() does, but the last of those loops keeps them among its live
/// lanes: next_turn() wakes them.
void MaskStack::continue_loop(int levels) {
    for (size_t i = blocks_.size(); i-- > 0;) {
        EnteredBlock& block = blocks_[i];
        if (block.kind == Kind::Loop && --levels <= 0) break;
        if (block.live) take_off(block.live);
        take_off(block.before);
    }
    run_none();
}

/// Lanes that return wake at the end of the scope: they leave all loops and halves inside it.
void MaskStack::leave_scope() {
    for (size_t i = blocks_.size(); i-- > 0;) {
        EnteredBlock& block = blocks_[i];
        if (block.kind == Kind::Scope) break;
        if (block.live) take_off(block.live);
        take_off(block.before);
    }
    run_none();
}

}  // namespace trapeze::vm
