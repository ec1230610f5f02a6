/// Which lanes of a grid run. Blocks in which lanes go separate ways nest; lanes that jump out of several
/// blocks are taken off each of them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "shade/planes/planes.h"

namespace trapeze::vm {

/// A lane runs where all bits are set.
using MaskPlane = std::span<uint32_t>;

class MaskStack {
  public:
    enum class State : uint8_t { None, Some, All };

    /// All of so many lanes (a multiple of kLanes) run.
    void start(size_t lanes);

    State state() const { return state_; }
    bool none() const { return state_ == State::None; }
    bool all() const { return state_ == State::All; }
    /// Of the lanes that run; meaningful in every state.
    const uint32_t* current() const { return current_; }

    void enter_if(const float* condition);
    void turn_to_else(const float* condition);
    void leave_block();

    void enter_loop();
    void test_loop(const float* condition);
    /// Lanes that continued run again.
    void next_turn();
    /// Lanes of the loop run again, but those only where `lanes` are set: a turn for one light.
    void start_turn(const float* lanes);
    bool loop_is_over() const;

    void enter_scope();
    /// The lanes that run leave `levels` loops, or go on with the next turn of the `levels`-th.
    void break_loops(int levels);
    void continue_loop(int levels);
    void leave_scope();

  private:
    enum class Kind : uint8_t { If, Loop, Scope };
    struct Block {
        Kind kind = Kind::If;
        uint32_t* before = nullptr;  ///< lanes that go on after it
        uint32_t* live = nullptr;    ///< of a loop: lanes that have not left it
    };

    uint32_t* take();
    void give_back(uint32_t* plane) { free_.push_back(plane); }
    Block& push(Kind kind);
    void take_off(uint32_t* plane) const;
    void copy(const uint32_t* from, uint32_t* to) const;
    void set_state();
    void run_none();

    struct Free {
        void operator()(uint32_t* p) const;
    };
    size_t lanes_ = 0, capacity_ = 0;
    uint32_t* current_ = nullptr;
    State state_ = State::All;
    std::vector<Block> blocks_;
    std::vector<std::unique_ptr<uint32_t, Free>> planes_;
    std::vector<uint32_t*> free_;
};

}  // namespace trapeze::vm
