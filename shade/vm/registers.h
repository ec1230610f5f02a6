/// A program's registers during a run on one thread: parameters, predefined variables, locals and
/// temporaries, each one or several planes of floats, and texts. Kept from run to run.
///
/// A caller sets parameters and variables after start() and before Machine::run(), and reads what the program
/// left in them afterwards, until the next start().
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "shade/vm/executable.h"

namespace trapeze::vm {

/// The executable is shared and held by pointer, so that a material may drop it while registers of a thread
/// are still there.
class Registers {
  public:
    explicit Registers(std::shared_ptr<const Executable> executable) : executable_(std::move(executable)) {}

    /// Registers for so many lanes (a multiple of kLanes); their contents are undefined, constants apart.
    void start(size_t lanes);

    const Executable& executable() const { return *executable_; }
    const rsl::Program& program() const { return executable_->program(); }
    size_t lanes() const { return lanes_; }

    const Operand& operand(rsl::RegisterId id) const { return by_id_[id]; }
    /// A step's operands in a row, outputs first.
    std::span<const Operand> operands_of(const Step& step) const {
        return {operands_.data() + step.first, step.count};
    }
    rsl::RegisterId register_of(const Step& step, size_t operand) const {
        return executable_->operands()[step.first + operand];
    }
    const rsl::Register& reg(rsl::RegisterId id) const { return program().reg(id); }

    /// A string register's; an array's element.
    std::string& text(rsl::RegisterId id, size_t element = 0) {
        return texts_[executable_->places()[id].at + element];
    }
    const std::string& text(rsl::RegisterId id, size_t element = 0) const {
        return texts_[executable_->places()[id].at + element];
    }

    /// Input number i of a step, counted from 0.
    const Operand& input(const Step& step, size_t i) const {
        return operands_[step.first + step.outputs + i];
    }
    const std::string& text_input(const Step& step, size_t i) const {
        return text(register_of(step, step.outputs + i));
    }

    /// Makes room for so many elements of an array whose memory grows; false when all of the program's
    /// together would be larger than they may be, and there is as much room as before. Operands are changed
    /// where they stand.
    bool grow(rsl::RegisterId id, size_t elements);
    /// Elements of such an array that there is room for.
    size_t room(rsl::RegisterId id) const { return growing_[executable_->places()[id].growing].elements; }
    /// Gives such an array so many elements, whatever they are; none where there is no room. Returns how many
    /// it has.
    size_t set_count(rsl::RegisterId id, size_t elements);
    /// How many it has, in the first lane.
    size_t count(rsl::RegisterId id) const;
    std::vector<std::string>& text_array(rsl::RegisterId id) {
        return growing_[executable_->places()[id].growing].texts;
    }
    const std::vector<std::string>& text_array(rsl::RegisterId id) const {
        return growing_[executable_->places()[id].growing].texts;
    }

    /// Fills a register with one value (its width of floats) for all lanes.
    void set_uniform(rsl::RegisterId id, const float* values, size_t element = 0);

  private:
    struct Free {
        void operator()(float* p) const;
    };
    /// The memory of an array that grows; it is kept from run to run.
    struct Growing {
        std::unique_ptr<float, Free> memory;
        size_t floats = 0;               ///< that there is memory for
        size_t elements = 0;             ///< that there is room for in this run
        std::vector<std::string> texts;  ///< in place of memory
        std::vector<uint32_t> uses;      ///< in operands_
    };
    void start_growing();

    std::shared_ptr<const Executable> executable_;
    std::vector<Growing> growing_;
    size_t grown_ = 0;  ///< floats of a vertex, of all arrays that grow together
    size_t lanes_ = 0, capacity_ = 0;
    std::unique_ptr<float, Free> memory_;
    std::vector<Operand> by_id_, operands_;
    std::vector<std::string> texts_;
};

}  // namespace trapeze::vm
