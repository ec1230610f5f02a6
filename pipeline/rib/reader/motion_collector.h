/// Motion blocks (RISpec 6): what stands between MotionBegin and MotionEnd, and transformations, which may
/// stand there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/rib/reader/request_report.h"
#include "pipeline/rib/state/deforming_shape.h"
#include "pipeline/rib/state/graphics_state_stack.h"
#include "pipeline/rib/syntax/arguments.h"

namespace trapeze::rib {

/// Geometry or transforms (not both), gathered between MotionBegin and MotionEnd. Times are seconds of the
/// scene, growing; there are as many transforms or shapes as times where the block is as it should be.
struct MotionBlock {
    SourceLocation at;
    std::vector<float> times;
    std::string request;  ///< what of transforms or geometry the block holds; empty: nothing yet
    TransformKind transform_kind = TransformKind::Matrix;
    bool stands_still = false;  ///< its times do not grow
    bool absolute = false;      ///< Transform, which replaces the current transformation
    std::vector<TransformArguments> transforms;
    std::vector<ShapePointer> shapes;
    /// Requests of other kinds (colours, shaders), which do not move: by name, in the order of the first
    /// ones.
    std::vector<std::vector<RequestText>> held;
};

/// The primitive of a motion block: its poses at growing times, or a single pose.
struct MovingShape {
    std::string request;
    SourceLocation at;
    std::vector<ShapePointer> shapes;
    std::vector<float> times;  ///< as many as shapes; seconds of the scene
};

/// Owns the open motion block, of which there is one at most. Transformations outside of motion blocks come
/// this way too, and are carried out at once.
class MotionCollector {
  public:
    MotionCollector(RequestReport& report, GraphicsStateStack& state) : report_(report), state_(state) {}

    /// Opens a block. Throws a RequestError for times that do not grow.
    void begin(std::vector<float> times);
    bool is_open() const { return state_.in_motion(); }

    /// Keeps an attribute or an option for the end of the block: carried out then, once, with its values as
    /// the shutter opens.
    void hold(RequestText text);
    /// Throws a RequestError where the block holds transforms or geometry of another request.
    void expect(const std::string& request);
    /// A pose of the primitive that was expected.
    void add_pose(ShapePointer shape) { block_.shapes.push_back(std::move(shape)); }

    /// Translate, Rotate and the like: before the current transformation, as points see it.
    void transform(TransformKind kind, TransformArguments arguments);
    /// Identity (null) and Transform, relative to GraphicsStateStack::root_transform().
    void set_transform(const TransformArguments* matrix);

    /// What was gathered, as the block ends.
    MotionBlock take() { return std::exchange(block_, {}); }
    /// One request that was held, given at some or all of the times, with its numbers as the shutter opens:
    /// between two times they are mixed. Says that they do not move where they should.
    RequestText as_shutter_opens(const std::vector<RequestText>& keys, const std::vector<float>& times);
    /// Puts the block's transforms into the current transformation, or returns its primitive. Where poses of
    /// a primitive are missing or do not match, its first pose stands for all times. Nothing where the block
    /// has no primitive.
    std::optional<MovingShape> resolve(MotionBlock block);

  private:
    /// `complete`: there are as many transforms as times.
    void concat(MotionBlock block, bool complete);
    MovingShape resolved_shape(MotionBlock block, bool complete);

    RequestReport& report_;
    GraphicsStateStack& state_;
    MotionBlock block_;
};

}  // namespace trapeze::rib
