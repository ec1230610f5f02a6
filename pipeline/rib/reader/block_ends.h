/// Ends of blocks, which concern several owners.
#pragma once

#include "pipeline/rib/reader/motion_collector.h"
#include "pipeline/rib/reader/request_report.h"
#include "pipeline/rib/reader/scene_builder.h"
#include "pipeline/rib/state/graphics_state_stack.h"

namespace trapeze::rib {

class RequestExecutor;

/// Closes blocks, the innermost first: the scene delivers its world, the motion block becomes a
/// transformation or a primitive, and the graphics state is what it was before.
class BlockEnds {
  public:
    BlockEnds(RequestReport& report, GraphicsStateStack& state, MotionCollector& motion, SceneBuilder& scene,
              RequestExecutor& executor)
        : report_(report), state_(state), motion_(motion), scene_(scene), executor_(executor) {}

    /// Closes the innermost block of the kind, and what is still open in it, which is an error each. Ends do
    /// not reach out of a world, but for FrameEnd.
    void end(BlockKind kind);
    /// What is open at the end of the input.
    void end_all();

    /// Runs `read` between AttributeBegin and AttributeEnd; blocks that it leaves open are closed.
    template <class Read>
    void within_attribute_block(Read&& read) {
        const size_t depth = begin_attribute_block();
        const uint64_t id = state_.blocks().back().id;
        read();
        end_attribute_block(depth, id);
    }

  private:
    void close_innermost();
    /// Called once the motion block is off the stack, so that what it gathered acts on the state around it.
    void finish_motion();
    size_t begin_attribute_block();
    void end_attribute_block(size_t depth, uint64_t id);

    RequestReport& report_;
    GraphicsStateStack& state_;
    MotionCollector& motion_;
    SceneBuilder& scene_;
    RequestExecutor& executor_;
};

}  // namespace trapeze::rib
