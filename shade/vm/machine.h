/// The grid machine: runs a program's steps one after the other, each over all vertices
/// [decision 0011].
#pragma once

#include <atomic>
#include <memory>
#include <unordered_map>
#include <vector>

#include "shade/vm/context.h"
#include "shade/vm/mask_stack.h"
#include "shade/vm/registers.h"

namespace trapeze::vm {

/// A thread's memory: registers of the programs it runs, and scratch planes. One run may start another (a
/// surface its lights); each has masks and scratch of its own. All of it is kept from run to run, since a
/// picture runs a few programs over very many grids of much the same size: nothing is allocated in a run once
/// it has reached its largest one. It is not thread-safe: each shading thread has its own.
class Machine {
  public:
    Machine();
    ~Machine();

    /// The thread's registers of an executable, number `copy` of those in use together.
    Registers& registers(const std::shared_ptr<const Executable>& executable, size_t copy = 0);

    /// What the runs at one depth of nesting need besides their registers.
    struct Level;

    /// Runs the program's code. The registers have been started, and its parameters and variables set. The
    /// context must live until the task is done.
    Task<> run(Registers& registers, const Context& context);
    /// Computes a parameter's default.
    Task<> run_initial(Registers& registers, size_t parameter, const Context& context);

  private:
    friend class Run;
    /// A program may be run several times at once: a layer that uses it twice, a light on a surface of the
    /// same shader.
    struct RegistersKey {
        const Executable* executable;
        size_t copy;
        bool operator==(const RegistersKey&) const = default;
    };
    struct RegistersKeyHash {
        size_t operator()(const RegistersKey& key) const {
            return std::hash<const void*>()(key.executable) + key.copy * 0x9e3779b97f4a7c15u;
        }
    };
    std::unordered_map<RegistersKey, std::unique_ptr<Registers>, RegistersKeyHash> registers_;
    std::vector<std::unique_ptr<Level>> levels_;
    size_t depth_ = 0;
};

/// One run of a program over a batch, as the operations that ask their context see it. Steps are done one
/// after the other, each over all lanes of the batch, so that the cost of finding out what is to be done is
/// shared by hundreds of vertices. Lanes past the batch's vertices are computed as well, and not read by
/// anyone.
class Run {
  public:
    Run(Machine& machine, Registers& registers, const Context& context);
    ~Run();
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;

    Task<> run(const std::vector<Step>& steps);

    Machine& machine() { return machine_; }
    Registers& registers() { return registers_; }
    const Context& context() const { return context_; }
    MaskStack& masks() { return masks_; }
    /// In an illuminance block: what the light of this turn sends; else null.
    const Lights::Arriving* light_of_turn() const {
        return light_loops_.empty() ? nullptr : light_loops_.back().light;
    }
    /// The variables of that light; behind all blocks those of the last turn's.
    const Registers* asked_light() const {
        return light_of_turn() ? light_of_turn()->registers : last_light_;
    }
    /// Whether an operand is the predefined P, which this program never sets.
    bool is_lasting_P(const Operand& operand) const {
        return operand.data == P_data() && registers_.executable().keeps_P();
    }
    size_t lanes() const { return registers_.lanes(); }
    /// Planes of lanes() floats in a row; given back when the step is done. Contents are undefined.
    float* scratch(size_t planes);

    /// A value's lane, for operations that work lane by lane.
    static float at(const Operand& operand, int component, size_t lane) {
        return operand.data[static_cast<size_t>(component) * operand.stride + (lane & operand.lane_mask)];
    }
    static V3f triple_at(const Operand& operand, size_t lane) {
        return {at(operand, 0, lane), at(operand, 1, lane), at(operand, 2, lane)};
    }
    void warn(const Step& step, std::string text, std::string kind);
    /// Counts work on so many elements of an array as steps of the loops around it.
    void count_elements(size_t elements) { loop_steps_ += static_cast<int64_t>(elements); }
    /// Counts a line of printf(); false when there have been so many that a loop must have gone wrong.
    bool may_print() { return ++printed_ <= kMostPrinted; }

  private:
    size_t run_to_wait(const std::vector<Step>& steps, size_t at);
    /// Does a step of control (control.cpp); returns where to go on. `at` is the step's index in `steps`.
    size_t control(const std::vector<Step>& steps, size_t at);
    Task<size_t> waiting_control(const std::vector<Step>& steps, size_t at);
    /// How a step that is no control is done. The choice is made anew for each step, by the masks as they are
    /// then.
    enum class Way : uint8_t { NotAtAll, InPlace, ThroughScratch };
    Way way_of(const Step& step) const;
    void plain(const Step& step);
    Task<> waiting(const Step& step);
    /// Operands of a step, with scratch in place of its outputs.
    class Redirected;
    void take_back(const Step& step, const Redirected& redirected);
    void call(const Step& step, std::span<const Operand> operands, size_t lanes);
    uint32_t planes_of(const Step& step, size_t output) const;
    void copy_planes(const Operand& from, size_t planes, float* to) const;
    void copy_running(bool masked, const float* from, size_t planes, const Operand& to) const;
    const float* condition(const Step& step);
    bool uniform_condition(const Step& step) const;
    size_t if_step(const Step& step, size_t at);
    size_t loop_step(const std::vector<Step>& steps, size_t at);
    size_t jump_step(const Step& step);
    /// Loops over lights and rays: what they have come to is on stacks, for these loops nest.
    bool enter_lights(const Step& step);
    const float* P_data() const;
    /// Bounds of LoopLimits, which end what a mistake in a shader would never end.
    bool steps_are_spent(const Step& opening, size_t steps);
    bool turns_are_spent(const Step& opening);
    Task<size_t> next_light(const std::vector<Step>& steps, size_t opening);
    std::unique_ptr<GatherTurns> gather_turns(const Step& step);
    Task<size_t> gather_step(const std::vector<Step>& steps, size_t at);
    Task<size_t> next_rays(const std::vector<Step>& steps, size_t opening);
    size_t turn_to_misses(const Step& step, size_t at);
    size_t enter_illuminate(const Step& step, size_t at);
    void leave_light(const Step& step, const Operand& L);

    Machine& machine_;
    Registers& registers_;
    const Context& context_;
    Machine::Level& level_;
    MaskStack& masks_;
    /// An Illuminance block that is being run.
    struct LightLoop {
        size_t next = 0;  ///< number of the next turn's light
        const Lights::Arriving* light = nullptr;
        bool refresh = false;
        std::vector<SentValue> sent;
        std::vector<uint32_t> lanes;  ///< that run, if anything is sent
    };
    std::vector<LightLoop> light_loops_;
    const Registers* last_light_ = nullptr;
    std::vector<std::unique_ptr<GatherTurns>> gathers_;  ///< of the Gather blocks that are being run
    std::unordered_map<const Step*, int> turns_;
    static constexpr int kMostPrinted = 100'000;
    int64_t loop_steps_ = 0;
    int printed_ = 0;
    size_t scratch_used_ = 0;
};

}  // namespace trapeze::vm
