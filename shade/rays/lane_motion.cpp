#include "shade/rays/lane_motion.h"

#include <cmath>

#include "core/motion_keys.h"
#include "core/random.h"
#include "core/scene/poses.h"
#include "core/scene/shading_grid.h"
#include "shade/rays/shortest_turn.h"

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
    if (!is_hit_ && grid_->primitive->shape_keys.size() > 1 && GridTangents::tell_of(grid_->shape))
        at_open_ = tangents(0);
}

V3f LaneMotion::turned(const V3f& direction, float time, bool diffuse) const {
    if (!is_hit_ && !diffuse) return direction;
    const V3f turned = turn_.forward(direction, time);
    return at_open_ && time != 0 ? turned_by_shape(turned, time, false) : turned;
}

V3f LaneMotion::turned_back(const V3f& direction, float time, bool diffuse) const {
    if (!is_hit_ && !diffuse) return direction;
    return turn_.back(at_open_ && time != 0 ? turned_by_shape(direction, time, true) : direction, time);
}

std::optional<M33f> LaneMotion::turn_of_space_alone(float time, bool diffuse) const {
    const bool turns = grid_ && time != 0 && (is_hit_ || diffuse);
    if (!turns || at_open_ || grid_->primitive->shape_keys.size() <= 1) return {};
    M33f turn;
    for (int axis = 0; axis < 3; ++axis) {
        V3f way(0, 0, 0);
        way[axis] = 1;
        const V3f turned = turn_.forward(way, time);
        for (int k = 0; k < 3; ++k) turn[axis][k] = turned[k];
    }
    return turn;
}

V3f LaneMotion::turned_by_shape(const V3f& direction, float time, bool back) const {
    const V3f before = turn_.forward(at_open_->normal(), time), now = tangents(time).normal();
    return back ? turned_from(now, before, direction) : turned_from(before, now, direction);
}

std::optional<V3f> LaneMotion::normal(const V3f& normal, float time) const {
    if (time == 0 || !grid_) return normal;
    if (grid_->primitive->shape_keys.size() > 1) return {};
    return turn_.normal(normal, time);
}

float LaneMotion::time(int sample) const {
    return varies_ ? shutter_time(sample, shift_) : only_time_;
}

V3f LaneMotion::place(int key, size_t vertex) const {
    const Triples& P = grid_->P[grid_->P.size() > 1 ? static_cast<size_t>(key) : 0];
    const V3f here = P.at(vertex);
    return held_.empty() ? here : here * held_at(held_, key, keys_);
}

V3f LaneMotion::way(float time) const {
    if (keys_ == 1 || time == 0) return V3f(0, 0, 0);
    return place_at(time, vertex_) - start();
}

V3f LaneMotion::place_at(float time, size_t vertex) const {
    if (keys_ == 1 || time == 0) return place(0, vertex);
    const MotionSegment at = segment_at(time, keys_);
    const V3f from = place(at.index, vertex), to = place(at.index + 1, vertex);
    return from + (to - from) * at.local;
}

const GridTangents& LaneMotion::tangents(float time) const {
    if (!at_known_time_ || known_time_ != time) {
        at_known_time_.emplace(grid_->shape, vertex_, [&](size_t vertex) { return place_at(time, vertex); });
        known_time_ = time;
    }
    return *at_known_time_;
}

}  // namespace trapeze
