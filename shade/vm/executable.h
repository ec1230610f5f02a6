/// A program made ready for the machine: kernels found, jumps resolved, registers given their places.
/// Immutable and shared by threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#include "core/task.h"
#include "shade/code/program.h"
#include "shade/vm/kernels/kernel.h"
#include "shade/vm/start_values.h"

namespace trapeze::vm {

/// A loop that has run so often in one run is taken to be endless: it is reported, and left.
inline constexpr int kMaxTurns = 100'000;

/// What a run may spend in loops.
struct LoopLimits {
    int turns = kMaxTurns;        ///< of one loop, each time it is entered
    int64_t steps = 100'000'000;  ///< of all loops together, nested ones counted as often as they run
};

class Run;
struct Step;

/// Does an operation that is no kernel: one on texts, spaces, neighbours, maps, lights or messages.
/// `operands` are the step's, but outputs may be scratch planes.
using ContextOp = void (*)(Run& run, const Step& step, std::span<const Operand> operands);

/// The same for operations that may run other shaders: those of lights, or of what rays hit.
using WaitingOp = Task<> (*)(Run& run, const Step& step, std::span<const Operand> operands);

/// Null for an operation that there is none for.
ContextOp find_context_op(rsl::Op op);
WaitingOp find_waiting_op(rsl::Op op);

/// One instruction. A flat copy of an Instruction with everything looked up that can be known before a run,
/// since a step is done for each batch of grids and an instruction is compiled once. Its operands are a range
/// of one array that all steps share.
struct Step {
    rsl::Op op = rsl::Op::Move;
    uint8_t outputs = 0;
    bool masked = false;   ///< lanes that do not run keep their outputs
    bool varying = false;  ///< for each lane; a block: lanes may go separate ways
    /// An output is also an input of an operation that looks at several lanes, or of a text.
    bool through_scratch = false;
    int32_t immediate = 0;
    uint32_t first = 0, count = 0;  ///< operands, in Executable::operands
    uint32_t target = 0;            ///< of control: the step to go on with when no lane is left
    Kernel kernel = nullptr;        ///< null: `context_op` or `waiting_op` does it; of control: the machine
    ContextOp context_op = nullptr;
    WaitingOp waiting_op = nullptr;
    bool waits = false;  ///< other shaders may have to run first: `waiting_op`, or control
    SourceLocation at;
};

/// Where a register is in the memory of Registers. Registers turns it into an address when a run says how
/// many lanes there are; until then only the order of the planes is settled.
struct Place {
    /// Where a register's values are: in the executable, shared by all runs; once for a run; once for each
    /// lane; or as strings, which have no planes.
    enum class Kind : uint8_t { Constant, Uniform, Varying, Text };
    Kind kind = Kind::Uniform;
    uint32_t at = 0;      ///< planes of kLanes floats (Constant, Uniform), planes (Varying), texts
    uint32_t planes = 1;  ///< of all elements together
    /// Of an array whose memory grows in a run (Registers::grow()): its number among these.
    uint32_t growing = kNone;
    static constexpr uint32_t kNone = ~0u;
};

/// Made once for a program and the parameters that vary, and then run over all grids of the materials that
/// use it. The one thing that changes is whether a loop has turned out to be endless, which all threads may
/// set.
class Executable {
  public:
    /// The program has been optimised, and its storage inferred.
    explicit Executable(rsl::Program source, const LoopLimits& limits = {});

    const rsl::Program& program() const { return program_; }
    const std::vector<Step>& code() const { return code_; }
    /// The default of program().parameters[i].
    const std::vector<Step>& initial(size_t i) const { return initials_[i]; }
    const std::vector<rsl::RegisterId>& operands() const { return operands_; }
    const std::vector<Place>& places() const { return places_; }
    uint32_t uniform_planes() const { return uniform_planes_; }
    uint32_t varying_planes() const { return varying_planes_; }
    /// Arrays whose memory grows, in the order of Place::growing.
    const std::vector<rsl::RegisterId>& growing() const { return growing_; }
    uint32_t text_count() const { return static_cast<uint32_t>(texts_.size()); }
    /// kLanes equal floats for each component of each constant, 64-byte aligned.
    const float* constants() const { return constants_.get(); }
    /// Texts at the start of a run: those of constants, others empty.
    const std::vector<std::string>& texts() const { return texts_; }

    /// The default of program().parameters[i] is to be computed in each run, by initial(i).
    bool has_run_default(size_t i) const { return run_defaults_[i]; }

    /// How each of program().globals gets the value with which a run starts.
    const std::vector<StartValue>& start_values() const { return start_values_; }

    /// The program never sets P.
    bool keeps_P() const { return keeps_P_; }

    /// Turns that a loop may take. Once a loop has turned out to be endless, other grids are not made to wait
    /// for as long.
    int max_turns() const {
        return is_endless() ? std::min(limits_.turns, kAfterwards.turns) : limits_.turns;
    }
    int64_t max_loop_steps() const {
        return is_endless() ? std::min(limits_.steps, kAfterwards.steps) : limits_.steps;
    }
    /// Set by a run whose loops were ended for taking too long, in any thread; counted by the library, as
    /// what such a shader leaves behind may depend on how its grids were parted.
    void found_endless() const { endless_.store(true, std::memory_order_relaxed); }
    bool is_endless() const { return endless_.load(std::memory_order_relaxed); }

  private:
    /// What loops may spend once one has been found endless: enough for most loops that do end, little enough
    /// that a frame of such grids still finishes.
    static constexpr LoopLimits kAfterwards{256, 100'000};

    void place_registers();
    std::vector<Step> make_steps(const rsl::Code& code);
    Kernel kernel_of(const rsl::Instruction& instruction) const;

    struct Free {
        void operator()(float* p) const;
    };
    rsl::Program program_;
    std::vector<Step> code_;
    std::vector<std::vector<Step>> initials_;
    std::vector<rsl::RegisterId> operands_;
    std::vector<Place> places_;
    std::vector<rsl::RegisterId> growing_;
    std::vector<std::string> texts_;
    std::vector<bool> run_defaults_;
    std::vector<StartValue> start_values_;
    uint32_t uniform_planes_ = 0, varying_planes_ = 0, constant_planes_ = 0;
    std::unique_ptr<float, Free> constants_;
    bool keeps_P_ = true;
    LoopLimits limits_;
    mutable std::atomic<bool> endless_{false};
};

}  // namespace trapeze::vm
