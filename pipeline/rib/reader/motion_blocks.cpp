/// MotionBegin, MotionEnd, and transformations, which may move.
#include "pipeline/rib/reader/reader.h"
#include "pipeline/rib/state/scene_size.h"

#include <algorithm>
#include <cmath>

namespace trapeze::rib {
namespace {

constexpr size_t kMostTimes = 1000;
constexpr int kMostMovingFactors = 1000;  ///< motion blocks that act on one transformation

/// Whether numbers may be taken between those of the two.
bool has_same_form(const RequestText& a, const RequestText& b) {
    return std::equal(a.arguments.begin(), a.arguments.end(), b.arguments.begin(), b.arguments.end(),
                      [](const Argument& x, const Argument& y) {
                          return x.kind == y.kind && x.strings == y.strings &&
                                 x.floats.size() == y.floats.size();
                      });
}

bool has_same_arguments(const RequestText& a, const RequestText& b) {
    return has_same_form(a, b) && std::equal(a.arguments.begin(), a.arguments.end(), b.arguments.begin(),
                                             [](const Argument& x, const Argument& y) {
                                                 return x.number == y.number && x.floats == y.floats;
                                             });
}

/// Where names or counts differ, the earlier one.
RequestText between(const RequestText& a, const RequestText& b, float t) {
    RequestText text = a;
    if (!has_same_form(a, b)) return text;
    for (size_t i = 0; i < text.arguments.size(); ++i) {
        Argument& argument = text.arguments[i];
        const Argument& later = b.arguments[i];
        argument.number += t * (later.number - argument.number);
        for (size_t k = 0; k < argument.floats.size(); ++k)
            argument.floats[k] += t * (later.floats[k] - argument.floats[k]);
    }
    return text;
}

}  // namespace

void Reader::begin_motion(std::vector<float> times) {
    if (motion_) throw RequestError{"motion blocks do not nest", {}};
    if (times.empty()) throw RequestError{"no times", {}};
    if (times.size() > kMostTimes)
        throw RequestError{"more than " + std::to_string(kMostTimes) + " times", {}};
    if (!std::isfinite(times.back() - times.front())) throw RequestError{"times are too far apart", {}};
    if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end())
        throw RequestError{"times must grow", {}};
    begin_block(Block::Motion);
    motion_.emplace();
    motion_->at = at_;
    motion_->times = std::move(times);
}

void Reader::hold_in_motion(RequestText text) {
    std::vector<std::vector<RequestText>>& held = motion_->others;
    const auto same = std::find_if(held.begin(), held.end(), [&](const std::vector<RequestText>& keys) {
        return keys.front().name == text.name;
    });
    (same == held.end() ? held.emplace_back() : *same).push_back(std::move(text));
}

void Reader::carry_out_held(std::vector<RequestText> keys, const std::vector<float>& times) {
    const std::string name = keys[0].name, outer_name = request_name_;
    const SourceLocation outer = at_;
    at_ = keys[0].at, request_name_ = name;
    RequestText text = keys[0];
    if (keys.size() != times.size()) {
        error(name + " occurs " + std::to_string(keys.size()) + " times for " + std::to_string(times.size()) +
              " times of the motion; the first is used");
    } else {
        const float open = scope_.options.shutter_open;
        const size_t next = std::upper_bound(times.begin(), times.end(), open) - times.begin();
        if (next == times.size())
            text = keys.back();
        else if (next > 0)
            text = between(keys[next - 1], keys[next],
                           (open - times[next - 1]) / (times[next] - times[next - 1]));
        const bool moves = std::any_of(keys.begin() + 1, keys.end(), [&](const RequestText& key) {
            return !has_same_arguments(key, keys[0]);
        });
        if (moves)
            diagnostics_.note(at_, name + ": does not move; its values as the shutter opens are used",
                              "motion-of-" + name);
    }
    try {
        carry_out(*find_request(name), text);
    } catch (const RequestError& problem) {
        error(problem.at, problem.text + "; request skipped");
    }
    at_ = outer, request_name_ = outer_name;
}

void Reader::finish_motion(MotionBlock block) {
    for (std::vector<RequestText>& keys : block.others) carry_out_held(std::move(keys), block.times);
    const size_t given = std::max(block.transforms.size(), block.shapes.size());
    if (given == 0) return;
    const bool complete = given == block.times.size();
    if (!complete)
        error(block.request + " occurs " + std::to_string(given) + " times for " +
              std::to_string(block.times.size()) + " times of the motion; the first is used");
    if (!block.transforms.empty()) {
        if (block.absolute) state_.transform = root_transform();
        if (!complete)
            state_.transform.concat(transform_matrix(block.transform_kind, block.transforms[0]));
        else if (state_.transform.moving_factors() >= kMostMovingFactors)
            error("more than " + std::to_string(kMostMovingFactors) +
                  " motion blocks act on one transformation; this one is ignored");
        else
            state_.transform.concat(
                MovingFactor{block.transform_kind, std::move(block.times), std::move(block.transforms)});
        return;
    }
    const float open = scope_.options.shutter_open, close = scope_.options.shutter_close;
    if (complete && settle_colors(block.shapes, block.times, open))
        diagnostics_.note(block.at,
                          block.request + ": its colours do not move; those as the shutter opens are used",
                          "motion-of-colours");
    if (complete && !can_deform(block.shapes)) {
        error("the shapes of the motion differ in topology or variables; the first is used");
        block.shapes.resize(1);
    }
    if (!complete) block.shapes.resize(1);
    block.times.resize(block.shapes.size());
    if (object_)
        object_->primitives.push_back({block.request,
                                       std::move(block.shapes),
                                       std::move(block.times),
                                       state_.transform,
                                       state_.attributes,
                                       block.at,
                                       {},
                                       0,
                                       0,
                                       solid_of_surface(object_->solids)});
    else {
        const auto keys = shapes_at_keys(block.shapes, block.times, open, close);
        if (keeps_geometry() && !has_room(keys.size() * bytes_of(*keys.front()))) return;
        emit(block.request, keys, state_.transform, state_.attributes, block.at, solid_of_surface(solids_));
    }
}

MovingTransform Reader::root_transform() const {
    return in_world_ && !object_ ? camera_ : MovingTransform();
}

void Reader::transform(TransformKind kind, TransformArguments arguments) {
    if (!motion_) {
        state_.transform.concat(transform_matrix(kind, arguments));
        return;
    }
    if (motion_->request.empty()) motion_->request = request_name_, motion_->transform_kind = kind;
    if (motion_->request != request_name_)
        throw RequestError{"this is a motion block of " + motion_->request, {}};
    motion_->transforms.push_back(std::move(arguments));
}

void Reader::set_transform(const TransformArguments* matrix) {
    if (motion_) {
        transform(TransformKind::Matrix,
                  matrix ? *matrix : TransformArguments{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
        motion_->absolute = true;
        return;
    }
    state_.transform = root_transform();
    if (matrix) state_.transform.concat(transform_matrix(TransformKind::Matrix, *matrix));
}

void Reader::name_coordinate_system(const std::string& name) {
    scope_.named_spaces[name] = state_.transform;
}

void Reader::name_scoped_coordinate_system(const std::string& name) {
    auto spaces = state_.scoped_spaces ? std::make_shared<NamedSpaces>(*state_.scoped_spaces)
                                       : std::make_shared<NamedSpaces>();
    (*spaces)[name] = state_.transform;
    state_.scoped_spaces = std::move(spaces);
    // Shaders look names up when the world is whole: there the first of a name stands for all.
    scope_.named_spaces.try_emplace(name, state_.transform);
}

const MovingTransform* Reader::named_space(const std::string& name) const {
    if (state_.scoped_spaces)
        if (const auto space = state_.scoped_spaces->find(name); space != state_.scoped_spaces->end())
            return &space->second;
    const auto space = scope_.named_spaces.find(name);
    return space == scope_.named_spaces.end() ? nullptr : &space->second;
}

void Reader::use_coordinate_system(const std::string& name) {
    if (motion_) throw RequestError{"inside a motion block", {}};
    if (object_) throw RequestError{"inside an object definition", {}};
    const MovingTransform* const space = named_space(name);
    if (!space && name != "camera") throw RequestError{"no coordinate system " + in_quotes(name), {}};
    state_.transform = space ? *space : MovingTransform();
}

M44f Reader::camera_from_current() const {
    return M44f(state_.transform.at(scope_.options.shutter_open));
}

bool Reader::is_right_handed() const {
    const float open = scope_.options.shutter_open;
    bool right = state_.transform.at(open).determinant() < 0;
    // An object's own space stands in that in which its definition began.
    for (const OpenBlock& block : blocks_)
        if (block.kind == Block::Object && block.saved.transform.at(open).determinant() < 0) right = !right;
    return right;
}

}  // namespace trapeze::rib
