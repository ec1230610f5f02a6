#include "shade/rays/lane_motion.h"

#include "core/motion_keys.h"
#include "core/random.h"
#include "core/scene/scene.h"

namespace trapeze {

/// Rays' own geometry has no motion of the camera in it.
LaneMotion::LaneMotion(const RayAsker& asker, const RayLane& lane, std::optional<float> given)
    : grid_(lane.grid) {
    if (!grid_) return;
    is_hit_ = grid_->hit_vertex >= 0;
    varies_ = !is_hit_ && !given && asker.samples_motion();
    only_time_ = given.value_or(is_hit_ ? grid_->hit_time : 0);
    const bool moves = varies_ || only_time_ != 0;
    const std::span<const M44f> held =
        is_hit_ || !moves ? std::span<const M44f>() : asker.service().held_from_camera;
    vertex_ = VertexMotion(*grid_, lane.lane - lane.first_of_grid, held);
    if (!moves) return;
    shift_ = unit_float(hash(lane.seed, 7));
    turn_ = turn_of(*grid_, held);
    tells_shape_ = !is_hit_ && vertex_.deforms() && vertex_.tells_bend();
}

V3f LaneMotion::turned(const V3f& direction, float time, bool diffuse) const {
    if (!is_hit_ && !diffuse) return direction;
    return tells_shape_ ? vertex_.forward(direction, time, turn_) : turn_.forward(direction, time);
}

V3f LaneMotion::turned_back(const V3f& direction, float time, bool diffuse) const {
    if (!is_hit_ && !diffuse) return direction;
    return tells_shape_ ? vertex_.back(direction, time, turn_) : turn_.back(direction, time);
}

std::optional<M33f> LaneMotion::turn_of_space_alone(float time, bool diffuse) const {
    const bool turns = grid_ && time != 0 && (is_hit_ || diffuse);
    if (!turns || tells_shape_ || !vertex_.deforms()) return {};
    M33f turn;
    for (int axis = 0; axis < 3; ++axis) {
        V3f way(0, 0, 0);
        way[axis] = 1;
        const V3f turned = turn_.forward(way, time);
        for (int k = 0; k < 3; ++k) turn[axis][k] = turned[k];
    }
    return turn;
}

std::optional<V3f> LaneMotion::normal(const V3f& normal, float time) const {
    if (time == 0 || !grid_) return normal;
    if (vertex_.deforms()) return {};
    return turn_.normal(normal, time);
}

float LaneMotion::time(int sample) const {
    return varies_ ? shutter_time(sample, shift_) : only_time_;
}

}  // namespace trapeze
