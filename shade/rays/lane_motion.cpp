#include "shade/rays/lane_motion.h"

#include "core/motion_keys.h"
#include "core/random.h"
#include "core/scene/poses.h"
#include "core/scene/shading_grid.h"

namespace trapeze {

LaneMotion::LaneMotion(const RayAsker& asker, const RayLane& lane, std::optional<float> given)
    : grid_(lane.grid), vertex_(lane.lane - lane.first_of_grid) {
    if (!grid_) return;
    is_hit_ = grid_->hit_vertex >= 0;
    varies_ = !is_hit_ && !given && asker.samples_motion();
    only_time_ = given.value_or(is_hit_ ? grid_->hit_time : 0);
    if (!varies_ && only_time_ == 0) return;
    shift_ = unit_float(hash(lane.seed, 7));
    // Rays' own geometry has no motion of the camera in it.
    if (!is_hit_) held_ = asker.service().held_from_camera;
    keys_ = motion_keys_of(*grid_, held_);
    turn_ = turn_of(*grid_, held_);
}

V3f LaneMotion::turned(const V3f& direction, float time, bool diffuse) const {
    return is_hit_ || diffuse ? turn_.forward(direction, time) : direction;
}

V3f LaneMotion::turned_back(const V3f& direction, float time, bool diffuse) const {
    return is_hit_ || diffuse ? turn_.back(direction, time) : direction;
}

std::optional<V3f> LaneMotion::normal(const V3f& normal, float time) const {
    if (time == 0 || !grid_) return normal;
    if (grid_->primitive->shape_keys.size() > 1) return {};
    return turn_.normal(normal, time);
}

float LaneMotion::time(int sample) const {
    return varies_ ? shutter_time(sample, shift_) : only_time_;
}

V3f LaneMotion::place(int key) const {
    const Triples& P = grid_->P[grid_->P.size() > 1 ? static_cast<size_t>(key) : 0];
    const V3f here = P.at(vertex_);
    return held_.empty() ? here : here * held_at(held_, key, keys_);
}

V3f LaneMotion::way(float time) const {
    if (keys_ == 1 || time == 0) return V3f(0, 0, 0);
    const MotionSegment at = segment_at(time, keys_);
    const V3f from = place(at.index), to = place(at.index + 1);
    return from + (to - from) * at.local - place(0);
}

}  // namespace trapeze
