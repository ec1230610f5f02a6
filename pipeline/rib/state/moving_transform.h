/// Transformations that move: kept as the requests that made them until the shutter is known, so that a
/// rotation stays a rotation between its keys. Row vectors: p' = p * M.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/math.h"

namespace trapeze::rib {

/// The requests of RISpec 4.3; Transform and Identity are a Matrix that replaces what was there.
enum class TransformKind { Translate, Rotate, Scale, Skew, Matrix, Perspective };

/// The numbers of the request: Translate and Scale 3, Rotate angle and axis, Skew angle and two vectors,
/// Matrix 16.
using TransformArguments = std::vector<float>;

/// In double, as a chain may be long: rounding to float happens once, when a primitive or a shader takes the
/// product. A vector without length makes the identity, not NaN: handlers have refused it before.
M44d transform_matrix(TransformKind kind, const TransformArguments& arguments);

/// Requests of one kind at given times (seconds of the scene); arguments between times are interpolated
/// linearly, outside they stay.
struct MovingFactor {
    TransformKind kind = TransformKind::Matrix;
    std::vector<float> times;
    std::vector<TransformArguments> arguments;

    /// The factor at a time of the scene: before the first of its times as at the first, after the last as at
    /// that.
    M44d at(float time) const;
    bool moves_between(float open, float close) const;
    /// Degrees that the fastest part within the shutter would turn in a whole shutter; 0 unless it rotates.
    float fastest_turn(float open, float close) const;
};

/// A chain of factors, the newest applied first. Copies share it: blocks nest deeply.
class MovingTransform {
  public:
    /// p' = p * new * old: the newest acts on points first, as RISpec has it.
    void concat(const M44d& matrix);
    void concat(MovingFactor factor);
    void concat(const MovingTransform& newer);
    /// Whether they are one chain, and not just equal.
    bool is_same_chain(const MovingTransform& other) const { return newest_ == other.newest_; }
    /// The whole product at a time of the scene, in seconds. Multiplied anew at each call.
    M44d at(float time) const;
    /// Whether any factor changes within the shutter. The product may stand still all the same, where two
    /// motions cancel.
    bool moves_between(float open, float close) const;
    /// Keys that the motion in the shutter wants: 1, or 2^m + 1 so that keys given on a dyadic division of
    /// the shutter are met and no segment turns by more than about ten degrees, or bends as much.
    int wanted_keys(float open, float close) const;
    /// False when every point moves straight, at a steady speed between keys: at most one motion acts in the
    /// shutter, and it turns nothing. Points that move themselves (`deforms`) only stay straight where they
    /// are shifted.
    bool may_bend(float open, float close, bool deforms) const;
    /// The times within the shutter that requests were given for and that no key meets; some of them where
    /// they are many.
    std::vector<float> unmet_times(float open, float close, int keys) const;
    /// For a limit (MotionCollector): each costs work at every key of every primitive.
    int moving_factors() const { return newest_ ? newest_->moving_factors : 0; }

  private:
    /// Whether a straight line between the keys is good enough, seen at the middle of each segment.
    bool is_nearly_linear(float open, float close, int keys) const;

    /// Either a fixed matrix or a moving factor.
    struct Factor {
        std::shared_ptr<const Factor> older;
        int moving_factors = 0;  ///< this and the older ones
        M44d fixed;
        std::optional<MovingFactor> moving;

        M44d at(float time) const { return moving ? moving->at(time) : fixed; }
    };
    std::shared_ptr<Factor> newest_;  ///< never changed while it is shared
};

/// Those of a motion's times within the shutter, in their order, that are none of so many even keys, or are
/// the same key as the time before or as the end of the shutter; 64 of them at most. `times` are in order.
std::vector<float> times_between_keys(const std::vector<float>& times, float open, float close, int keys);

/// The smallest 2^m + 1 (m <= 4) whose even keys meet all of the times within the shutter; 17 when none does.
int keys_meeting(const std::vector<float>& times, float open, float close);

}  // namespace trapeze::rib
