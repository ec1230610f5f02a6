/// Motion blocks hold one of three things. Transforms become one moving factor of the current transformation;
/// poses of a primitive become one deforming primitive; all other requests are held and carried out once.
#include "pipeline/rib/reader/motion_collector.h"

#include <algorithm>
#include <cmath>

namespace trapeze::rib {
namespace {

/// The most times of one block: each is a pose in memory.
constexpr size_t kMostTimes = 1000;
/// Each is multiplied out at every key of every primitive.
constexpr int kMostMovingFactors = 1000;  ///< motion blocks that act on one transformation

/// Whether numbers may be taken between those of the two.
bool has_same_form(const RequestText& a, const RequestText& b) {
    return std::equal(a.arguments.begin(), a.arguments.end(), b.arguments.begin(), b.arguments.end(),
                      [](const Argument& x, const Argument& y) {
                          return x.kind == y.kind && x.strings == y.strings &&
                                 x.floats.size() == y.floats.size();
                      });
}

/// Whether the request is the same at two times: nothing moves between them.
bool has_same_arguments(const RequestText& a, const RequestText& b) {
    return has_same_form(a, b) && std::equal(a.arguments.begin(), a.arguments.end(), b.arguments.begin(),
                                             [](const Argument& x, const Argument& y) {
                                                 return x.number == y.number && x.floats == y.floats;
                                             });
}

/// Where names or counts differ, the earlier one. Of Rotate and the like the motion is another matter
/// (MovingFactor): only held attributes and options come here.
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

/// Times are in the unit of Shutter, whichever that is: nothing else is compared with them.
void MotionCollector::begin(std::vector<float> times) {
    if (is_open()) throw RequestError{"motion blocks do not nest", {}};
    if (times.empty()) throw RequestError{"no times", {}};
    if (times.size() > kMostTimes)
        throw RequestError{"more than " + std::to_string(kMostTimes) + " times", {}};
    if (!std::isfinite(times.back() - times.front())) throw RequestError{"times are too far apart", {}};
    const bool grows = std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end();
    if (!grows) report_.error("times must grow; the first of what the block holds is used");
    state_.open(BlockKind::Motion, report_.at());
    block_ = {};
    block_.at = report_.at();
    block_.times = std::move(times);
    block_.stands_still = !grows;
}

/// Few different requests stand in one block: they are searched one by one.
void MotionCollector::hold(RequestText text) {
    const auto same =
        std::find_if(block_.held.begin(), block_.held.end(),
                     [&](const std::vector<RequestText>& keys) { return keys.front().name == text.name; });
    (same == block_.held.end() ? block_.held.emplace_back() : *same).push_back(std::move(text));
}

/// A block of transforms may not turn into another kind of transform half-way: their numbers could not be
/// mixed.
void MotionCollector::expect(const std::string& request) {
    if (block_.request.empty()) block_.request = request;
    if (block_.request != request) throw RequestError{"this is a motion block of " + block_.request, {}};
}

/// In a motion block the arguments are kept and not the matrix: half-way between two rotations the angle is
/// to be mixed, which matrices cannot say.
void MotionCollector::transform(TransformKind kind, TransformArguments arguments) {
    if (!is_open()) {
        state_.current().transform.concat(transform_matrix(kind, arguments));
        return;
    }
    if (block_.request.empty()) block_.transform_kind = kind;
    expect(report_.name());
    block_.transforms.push_back(std::move(arguments));
}

/// Identity in a motion block is a Transform by the identity matrix, so that both kinds can stand in one
/// block. The root is put under it as the block ends (concat()).
void MotionCollector::set_transform(const TransformArguments* matrix) {
    if (is_open()) {
        transform(TransformKind::Matrix,
                  matrix ? *matrix : TransformArguments{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
        block_.absolute = true;
        return;
    }
    state_.current().transform = state_.root_transform();
    if (matrix) state_.current().transform.concat(transform_matrix(TransformKind::Matrix, *matrix));
}

/// Shading happens once in a frame, so colours and shaders cannot move; half-way between two keys they are
/// mixed like any numbers.
RequestText MotionCollector::as_shutter_opens(const std::vector<RequestText>& keys,
                                              const std::vector<float>& times) {
    const std::string& name = keys[0].name;
    const bool grows = std::ranges::adjacent_find(times, std::greater_equal<>()) == times.end();
    if (!grows) return keys[0];  // which has been told
    if (keys.size() != times.size()) {
        report_.error(name + " occurs " + std::to_string(keys.size()) + " times for " +
                      std::to_string(times.size()) + " times of the motion; the first is used");
        return keys[0];
    }
    RequestText text = keys[0];
    const float open = state_.options().shutter_open;
    const size_t next = std::upper_bound(times.begin(), times.end(), open) - times.begin();
    if (next == times.size())
        text = keys.back();
    else if (next > 0)
        text =
            between(keys[next - 1], keys[next], (open - times[next - 1]) / (times[next] - times[next - 1]));
    const bool moves = std::any_of(keys.begin() + 1, keys.end(),
                                   [&](const RequestText& key) { return !has_same_arguments(key, keys[0]); });
    if (moves)
        report_.note(report_.at(), name + ": does not move; its values as the shutter opens are used",
                     "motion-of-" + name);
    return text;
}

/// Poses are counted against the times: a block that has fewer, or more, stands still. One of attributes
/// alone, or of nothing, has neither transforms nor a primitive, which is no error.
std::optional<MovingShape> MotionCollector::resolve(MotionBlock block) {
    const size_t given = std::max(block.transforms.size(), block.shapes.size());
    if (given == 0) return {};
    const bool complete = given == block.times.size() && !block.stands_still;
    if (given != block.times.size())
        report_.error(block.request + " occurs " + std::to_string(given) + " times for " +
                      std::to_string(block.times.size()) + " times of the motion; the first is used");
    if (block.transforms.empty()) return resolved_shape(std::move(block), complete);
    concat(std::move(block), complete);
    return {};
}

/// A motion without its full number of times stands still at its first pose. The limit is one of work: each
/// moving factor is evaluated at each key of each primitive.
void MotionCollector::concat(MotionBlock block, bool complete) {
    MovingTransform& transform = state_.current().transform;
    if (block.absolute) transform = state_.root_transform();
    if (!complete)
        transform.concat(transform_matrix(block.transform_kind, block.transforms[0]));
    else if (transform.moving_factors() >= kMostMovingFactors)
        report_.error("more than " + std::to_string(kMostMovingFactors) +
                      " motion blocks act on one transformation; this one is ignored");
    else
        transform.concat(
            MovingFactor{block.transform_kind, std::move(block.times), std::move(block.transforms)});
}

/// Poses must have one form (can_deform); colours in them do not move (use_colors_at_open).
MovingShape MotionCollector::resolved_shape(MotionBlock block, bool complete) {
    if (complete && use_colors_at_open(block.shapes, block.times, state_.options().shutter_open))
        report_.note(block.at,
                     block.request + ": its colours do not move; those as the shutter opens are used",
                     "motion-of-colours");
    if (complete && give_missing_variables(block.shapes))
        report_.warn_once(
            block.request + ": later shapes of the motion lack variables; they have the first one's",
            "motion-variables");
    if (complete && !can_deform(block.shapes)) {
        report_.error("the shapes of the motion differ in topology or variables; the first is used");
        block.shapes.resize(1);
    }
    if (!complete) block.shapes.resize(1);
    block.times.resize(block.shapes.size());
    return {std::move(block.request), block.at, std::move(block.shapes), std::move(block.times)};
}

}  // namespace trapeze::rib
