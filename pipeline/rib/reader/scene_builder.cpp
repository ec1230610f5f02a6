/// Worlds and their primitives. Objects are in objects.cpp, lights in world_lights.cpp, solids in solids.cpp.
#include <algorithm>
#include <cmath>

#include "pipeline/rib/reader/scene_builder.h"
#include "pipeline/rib/state/held_camera.h"
#include "pipeline/rib/state/motion_paths.h"
#include "pipeline/rib/state/scene_size.h"

namespace trapeze::rib {
namespace {

constexpr float kMostSharpSamples = 4;  ///< along each side of a pixel, of a hider's samples without blur

/// Control points, as the summary counts them; quadrics have none.
uint64_t point_count(const Shape& shape) {
    if (std::holds_alternative<Quadric>(shape.topology)) return 0;
    return static_cast<uint64_t>(variable_counts(shape.topology).vertex);
}

/// The most by which a matrix makes a vector longer, or somewhat more: exact when it scales all vectors
/// alike. With A = the linear part and G = A A^T, the largest eigenvalue of G is at most its largest row sum.
float largest_stretch(const M44f& m) {
    V3d rows[3];
    for (int i = 0; i < 3; ++i) rows[i] = V3d(m[i][0], m[i][1], m[i][2]);
    double largest = 0;
    for (const V3d& a : rows) {
        double sum = 0;
        for (const V3d& b : rows) sum += std::abs(a.dot(b));
        largest = std::max(largest, sum);
    }
    return static_cast<float>(std::sqrt(largest));
}

/// A transformation that overflowed would spoil every bound that it is in.
bool is_finite(const M44f& m) {
    float sum = 0;  // 0 times what is not finite is NaN
    for (int i = 0; i < 16; ++i) sum += m[i / 4][i % 4] * 0;
    return sum == 0;
}

/// What unfolds from a flat shape, or from a point, is shaded as it begins to.
void unfold_first(std::vector<M44f>& spaces) {
    constexpr float kBeginning = 1.0f / 16384;
    const auto is_singular = [](const M44f& space) { return M44d(space).determinant() == 0; };
    if (!is_singular(spaces.front())) return;
    const auto whole = std::ranges::find_if_not(spaces, is_singular);
    if (whole != spaces.end()) spaces.front() += (*whole - spaces.front()) * kBeginning;
}

}  // namespace

/// Frames that are not wanted are read all the same: what they define may be used, and mistakes in them be
/// found.
void SceneBuilder::begin_frame(int number) {
    if (state_.in_world()) throw RequestError{"inside a world", {}};
    if (state_.is_open(BlockKind::Frame)) throw RequestError{"a frame is open already", {}};
    state_.open(BlockKind::Frame, report_.at());
    state_.options().frame = number;
    ++report_.summary().frames;
    frame_is_wanted_ = !read_options_.wants_frame || read_options_.wants_frame(number);
}

void SceneBuilder::begin_world() {
    if (state_.in_world()) throw RequestError{"a world is open already", {}};
    state_.open(BlockKind::World, report_.at());
    // Without it, as for shadow maps, all is seen as the shutter opens.
    Options& options = state_.options();
    if (options.hider_parameters.float_or("samplemotion", 1) == 0)
        options.shutter_close = options.shutter_open;
    report_turned_away();
    scene_ = Scene();
    solids_ = {};
    in_spaces_.clear();
    last_place_ = {};
    instanced_primitives_ = 0, instances_ = 0;
}

/// Maps are made where they stand, so that a later world can use them; a shadow map's picture is that of an
/// earlier world.
void SceneBuilder::make_map(MapRequest request) {
    if (state_.in_world()) throw RequestError{"inside a world", {}};
    if (!frame_is_wanted_ || !read_options_.on_map) return;
    request.location = report_.at();
    request.folders = search_.folders("texture");
    request.transfer = transfer_of(state_.options());
    read_options_.on_map(request);
}

/// Types of Quantize that are no display's: displays may come after it.
void SceneBuilder::report_quantized() {
    const Options& options = state_.options();
    for (const auto& [type, at] : state_.scope().quantized) {
        constexpr std::string_view kOfPictures[] = {"rgba", "z", "Ci", "Cs", "Oi", "Os"};
        const bool is_shown = std::ranges::any_of(options.displays, [&type = type](const Display& display) {
            return display.variable && display.variable->name == type;
        });
        if (is_shown || std::ranges::find(kOfPictures, type) != std::end(kOfPictures)) continue;
        const OtherRequest there(report_, at, "Quantize");
        report_.warn_once(
            in_quotes(type) + " is not known: the type is \"rgba\", \"z\" or a display's variable",
            "quantize-" + type);
    }
}

/// Spaces are taken as the shutter opens: shaders know no others. The options are moved out of the scope,
/// whose own are restored right afterwards.
void SceneBuilder::deliver_world() {
    ++report_.summary().worlds;
    report_quantized();
    Scope& scope = state_.scope();
    Options& options = scope.options;
    const float open = options.shutter_open;
    if (options.pixel_variance > 0 && !options.adaptive) ++report_.summary().without_effect["PixelVariance"];
    // A hider's counts are of paths: where nothing is blurred, edges need fewer.
    if (!scope.has_pixel_samples && options.f_stop >= kInfinity && options.shutter_close <= open) {
        options.samples_x = std::min(options.samples_x, kMostSharpSamples);
        options.samples_y = std::min(options.samples_y, kMostSharpSamples);
    }
    scene_.camera_from_world = M44f(state_.camera_from_world().at(open));
    scene_.held_from_camera = held_camera(state_.camera_from_world(), open, options.shutter_close);
    for (const auto& [name, space] : scope.named_spaces)
        scene_.camera_from_named[name] = M44f(space.at(open));
    for (const char* category : {"archive", "shader", "texture"})
        options.search_paths[category] = search_.folders(category);
    const bool wanted = frame_is_wanted_ && (state_.is_open(BlockKind::Frame) || !read_options_.wants_frame ||
                                             read_options_.wants_frame(options.frame));
    scene_.solids = std::move(solids_.solids);
    scene_.options = std::move(options);
    for (const ReadPlane& plane : scope.clipping_planes)
        scene_.clipping_planes.push_back(plane.in_shutter(open, scene_.options.shutter_close));
    resolved_ = {};
    bind_spaces();
    light_world();
    if (wanted) on_world_(std::move(scene_));
    scene_ = Scene();
    scene_bytes_ = 0;
}

/// The bound in camera space: its own length, times the most that its space stretches any length at any key.
float SceneBuilder::displacement_length(const GraphicsState& state,
                                        std::span<const M44f> camera_from_object) {
    const DisplacementBound& bound = state.attributes->displacement_bound;
    if (bound.sphere == 0 || bound.coordinate_system == "camera") return bound.sphere;
    float stretch = 0;
    for (const M44f& key : camera_from_object) stretch = std::max(stretch, largest_stretch(key));
    const auto& shader = state.attributes->attributes.displacement;
    if (const MovingTransform* const named =
            state_.named_space(bound.coordinate_system, state.scoped_spaces.get()))
        stretch = largest_stretch(M44f(named->at(state_.options().shutter_open)));
    else if (bound.coordinate_system == "shader" && shader)
        stretch = largest_stretch(shader->camera_from_shader);
    else if (bound.coordinate_system != "object" && bound.coordinate_system != "current" &&
             bound.coordinate_system != "shader")
        report_.warn_once("the displacement bound's coordinate system " + in_quotes(bound.coordinate_system) +
                              " is not known; object space is used",
                          "displacementbound-" + bound.coordinate_system);
    return bound.sphere * stretch;
}

/// Attributes as the scene has them; primitives in a row mostly share one set, which is made once.
/// `mirrored`: the determinant of their space is negative. A mirrored space, orientation "inside" and
/// ReverseOrientation turn normals over once each, so that two of them cancel.
std::shared_ptr<const Attributes> SceneBuilder::resolved_attributes(const GraphicsState& in,
                                                                    std::span<const M44f> camera_from_object,
                                                                    bool mirrored) {
    const std::shared_ptr<const AttributeState>& state = in.attributes;
    const bool inside = state->orientation == Orientation::Inside;
    const bool reverse = (mirrored != inside) != state->orientation_reversed;
    const float bound = displacement_length(in, camera_from_object);
    if (resolved_.state == state && resolved_.attributes->reverse_orientation == reverse &&
        resolved_.attributes->displacement_bound == bound)
        return resolved_.attributes;
    const SeenNumbers seen = state->detail.seen();
    const bool is_as_it_is = !reverse && bound == 0 && seen.are_all() && !read_options_.shading_rate;
    if (is_as_it_is) {  // shared with the state, which nobody changes from now on (change_attributes())
        resolved_ = {state, {state, &state->attributes}};
        return resolved_.attributes;
    }
    auto attributes = std::make_shared<Attributes>(state->attributes);
    attributes->reverse_orientation = reverse;
    attributes->displacement_bound = bound;
    set_seen_numbers(*attributes, seen);
    if (read_options_.shading_rate) attributes->shading_rate = *read_options_.shading_rate;
    resolved_ = {state, attributes};
    return attributes;
}

/// Adds to what the world takes; false, and an error, when that is too much. The count grows even where there
/// is no room, so that the first primitive beyond the limit ends all that follow, small ones included.
bool SceneBuilder::has_room(uint64_t bytes) {
    scene_bytes_ += bytes;
    if (scene_bytes_ <= read_options_.most_scene_bytes) return true;
    report_.error_of_limit("the scene takes more than " +
                               std::to_string(read_options_.most_scene_bytes >> 20) +
                               " MiB, which is the limit; this and further primitives are left out",
                           "scene-limit");
    return false;
}

/// At the keys that the motion in the shutter wants; found once for primitives that follow each other.
SceneBuilder::Place SceneBuilder::place_of(const MovingTransform& transform, const ShapeKeys& shape_keys) {
    const float open = state_.options().shutter_open, close = state_.options().shutter_close;
    if (last_place_.transform && last_place_.transform->is_same_chain(transform) &&
        last_place_.open == open && last_place_.close == close)
        return last_place_.place;
    const int keys =
        close > open ? keys_for_paths(transform, open, close, shape_keys, make_camera(state_.options())) : 1;
    Place place;
    if (keys == 1) {
        const M44f pose(transform.at(open));
        if (is_finite(pose)) place.determinant = M44d(pose).determinant();
        place.poses = SharedPoses(pose);
        last_place_ = {transform, open, close, place};
    } else {
        std::vector<M44f> poses;
        for (int k = 0; k < keys; ++k) poses.push_back(M44f(transform.at(key_time(open, close, k, keys))));
        unfold_first(poses);
        if (std::ranges::all_of(poses, is_finite)) place.determinant = M44d(poses.front()).determinant();
        place.poses = poses;
    }
    return place;
}

/// The last step of a primitive: its keys of transformation, its attributes, and the scene. `solid` is the
/// scene's that it bounds, or -1.
void SceneBuilder::emit(const std::string& request, ShapeKeys shape_keys, const GraphicsState& state,
                        SourceLocation at, int solid) {
    Primitive primitive;
    primitive.location = at;
    primitive.solid = solid;
    primitive.instance = instance_;
    const Place place = place_of(state.transform, shape_keys);
    // A singular transformation flattens the shape: it has no inside, and its normals no direction.
    if (!(std::abs(place.determinant) > 0)) {
        const std::string what = request == report_.name() ? "" : request + ": ";
        report_.error(at, what + "the current transformation is singular; primitive skipped");
        return;
    }
    primitive.shape_keys = std::move(shape_keys);
    primitive.camera_from_object = place.poses;
    ++primitive_counts_.of(report_.summary().primitives, request);
    report_.summary().points += point_count(primitive.shape());
    if (primitive.key_count() > 1) ++report_.summary().moving_primitives;
    if (!keeps_geometry() || state.attributes->detail.seen().are_none()) return;
    // Shared attributes and poses take memory once.
    const std::shared_ptr<const Attributes> last = resolved_.attributes;
    const bool is_elsewhere =
        scene_.primitives.empty() ||
        scene_.primitives.back().camera_from_object.data() != primitive.camera_from_object.data();
    // dPdu x dPdv in camera space is the transformed outward normal times the sign of the determinant.
    primitive.attributes = resolved_attributes(state, place.poses, place.determinant < 0);
    if (const auto& emitter = state.attributes->emitter) primitive.emitter = emitter->light;
    uint64_t bytes = bytes_of(primitive);
    if (primitive.attributes != last) bytes += bytes_of(*primitive.attributes);
    if (is_elsewhere) bytes += place.poses.size() * sizeof(M44f);
    if (!has_room(bytes) || !remember_spaces(state.scoped_spaces)) return;
    scene_.primitives.push_back(std::move(primitive));
}

/// False is no error: the caller leaves the primitive out, and one message stands for all of them later
/// (report_turned_away()).
bool SceneBuilder::takes_geometry() {
    if (state_.in_world() || object_) return true;
    if (report_.summary().worlds > 0) throw RequestError{"geometry outside of a world", {}};
    if (turned_away_.count++ == 0) turned_away_.first = report_.at(), turned_away_.request = report_.name();
    return false;
}

/// An input without any world is an archive, which may have geometry where it likes. What it is can be told
/// only later: an archive that is read by itself, or a scene with a mistake.
void SceneBuilder::report_turned_away() {
    if (turned_away_.count == 0) return;
    const std::string count =
        turned_away_.count == 1 ? "1 primitive" : std::to_string(turned_away_.count) + " primitives";
    if (state_.in_world()) {
        const OtherRequest first(report_, turned_away_.first, turned_away_.request);
        report_.error("geometry outside of a world; " + count + " skipped");
    } else {
        report_.note(turned_away_.first,
                     count +
                         " outside of a world, in an input that has none: an archive for other files to "
                         "read");
    }
    turned_away_.count = 0;
}

/// What the archive being read has made before, where it is the same; null when there is no room for a new
/// one. Poses of a motion are counted at its end, at the keys that the scene has.
ShapePointer SceneBuilder::shared_or_new(Shape&& shape) {
    auto shared = std::make_shared<const Shape>(std::move(shape));
    if (place_.share(shared)) return shared;
    if (keeps_geometry() && !motion_.is_open() && !has_room(bytes_of(*shared))) return nullptr;
    return shared;
}

/// A light that waits for its shape takes this one, in whichever of the three places it then goes to.
void SceneBuilder::add_shape(const std::string& request, Shape&& shape, uint64_t faces) {
    if (!takes_geometry()) return;
    if (motion_.is_open()) motion_.expect(request);
    report_.summary().faces += faces;
    place_emitter(state_.attributes(), shape, state_.camera_from_current());
    ShapePointer shared = shared_or_new(std::move(shape));
    if (!shared) return;
    if (motion_.is_open())
        motion_.add_pose(std::move(shared));
    else if (object_)
        add_to_object(request, {std::move(shared)}, {0.0f}, report_.at());
    else
        emit(request, ShapeKeys(std::move(shared)), state_.current(), report_.at(),
             solid_of_surface(solids_));
}

/// Poses are made at the even keys of the shutter, which later stages want; an object keeps those given,
/// since it may be placed under another shutter.
void SceneBuilder::add_moving_shape(MovingShape moving) {
    if (object_)
        return add_to_object(std::move(moving.request), std::move(moving.shapes), std::move(moving.times),
                             moving.at);
    const float open = state_.options().shutter_open, close = state_.options().shutter_close;
    const int wanted = keys_for_poses(moving.shapes, moving.times, state_.current().transform, open, close,
                                      make_camera(state_.options()));
    const auto keys = shapes_at_keys(moving.shapes, moving.times, open, close, wanted);
    if (keeps_geometry() && !has_room(keys.size() * bytes_of(*keys.front()))) return;
    emit(moving.request, keys, state_.current(), moving.at, solid_of_surface(solids_));
}

/// The transformation is the object's own from where its definition began.
void SceneBuilder::add_to_object(std::string request, std::vector<ShapePointer> shapes,
                                 std::vector<float> times, SourceLocation at) {
    object_->primitives.push_back({std::move(request),
                                   std::move(shapes),
                                   std::move(times),
                                   state_.current().transform,
                                   state_.current().attributes,
                                   at,
                                   {},
                                   0,
                                   0,
                                   solid_of_surface(object_->solids),
                                   state_.current().scoped_spaces});
}

}  // namespace trapeze::rib
