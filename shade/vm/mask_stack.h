/// Which lanes of a batch run. Blocks in which lanes go separate ways nest; lanes that jump out of several
/// blocks are taken off each of them.
///
/// A mask is a plane of 32-bit words, all bits of a lane set or none, in the form that kernels and
/// comparisons give and take as floats. There is one mask of the lanes that run now, and for each open block
/// a copy of those that go on behind it. What a lane is taken off of decides where it wakes up again: of the
/// current mask alone, at the block's end (or Else); of a loop's `live` lanes, behind the loop; of `before`
/// too, further out.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "shade/planes/planes.h"

namespace trapeze::vm {

/// A lane runs where all bits are set.
using MaskPlane = std::span<uint32_t>;

/// The masks of one run. Only blocks where lanes may part are entered here; a block whose condition is
/// uniform leaves all masks as they are, and the machine jumps.
class MaskStack {
  public:
    /// Whether no, some or all of the lanes run.
    enum class State : uint8_t { None, Some, All };

    /// All of so many lanes (a multiple of kLanes) run.
    void start(size_t lanes);

    State state() const { return state_; }
    bool none() const { return state_ == State::None; }
    bool all() const { return state_ == State::All; }
    /// The mask of the lanes that run; meaningful in every state.
    const uint32_t* current() const { return current_; }

    /// Lanes go on in the first half where the condition holds, and in the second where it does not.
    void enter_if(const float* condition);
    void turn_to_else(const float* condition);
    /// All lanes that entered the innermost block and have not jumped out of it run again.
    void leave_block();

    /// The lanes that run now take part in a loop, of which each leaves when its own test fails.
    void enter_loop();
    void test_loop(const float* condition);
    /// Lanes that continued run again.
    void next_turn();
    /// Lanes of the loop run again, but those only where `lanes` are set: a turn for one light.
    void start_turn(const float* lanes);
    bool loop_is_over() const;

    /// A body that lanes may return from one by one.
    void enter_scope();
    /// The lanes that run leave `levels` loops, or go on with the next turn of the `levels`-th.
    void break_loops(int levels);
    void continue_loop(int levels);
    void leave_scope();

  private:
    /// A Scope is what `return` leaves: the body of a function, or the shader's.
    enum class Kind : uint8_t { If, Loop, Scope };
    /// A block that lanes are in: what it must know to wake them again.
    struct EnteredBlock {
        Kind kind = Kind::If;
        uint32_t* before = nullptr;  ///< lanes that go on after it
        uint32_t* live = nullptr;    ///< of a loop: lanes that have not left it
    };

    /// A plane for the masks of one block, from those given back or a new one; its contents are undefined.
    uint32_t* take();
    void give_back(uint32_t* plane) { free_.push_back(plane); }
    EnteredBlock& push(Kind kind);
    /// Clears the lanes that run now in another mask.
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
    std::vector<EnteredBlock> blocks_;
    std::vector<std::unique_ptr<uint32_t, Free>> planes_;
    std::vector<uint32_t*> free_;
};

}  // namespace trapeze::vm
