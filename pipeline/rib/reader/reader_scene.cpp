/// What the reader puts into scenes: primitives, lights, shaders.
#include <algorithm>
#include <cmath>

#include "pipeline/rib/reader/reader.h"
#include "pipeline/rib/state/motion_paths.h"
#include "pipeline/rib/state/scene_size.h"

namespace trapeze::rib {
namespace {

uint64_t point_count(const Shape& shape) {
    if (std::holds_alternative<Quadric>(shape.topology)) return 0;
    return static_cast<uint64_t>(variable_counts(shape.topology).vertex);
}

/// No vector becomes longer than so many times its length: a bound that is exact when all grow alike.
/// With A = the linear part and G = A A^T, the largest eigenvalue of G is at most its largest row sum.
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

bool is_finite(const M44f& m) {
    return std::all_of(&m[0][0], &m[0][0] + 16, [](float v) { return std::isfinite(v); });
}

std::vector<ShapePointer> only(ShapePointer shape) {
    std::vector<ShapePointer> keys;
    keys.push_back(std::move(shape));
    return keys;
}

}  // namespace

float Reader::displacement_length(const AttributeState& state, const std::vector<M44f>& camera_from_object) {
    const DisplacementBound& bound = state.displacement_bound;
    if (bound.sphere == 0 || bound.coordinate_system == "camera") return bound.sphere;
    float stretch = 0;
    for (const M44f& key : camera_from_object) stretch = std::max(stretch, largest_stretch(key));
    const auto& shader = state.attributes.displacement;
    if (const MovingTransform* const named = named_space(bound.coordinate_system))
        stretch = largest_stretch(M44f(named->at(scope_.options.shutter_open)));
    else if (bound.coordinate_system == "shader" && shader)
        stretch = largest_stretch(shader->camera_from_shader);
    else if (bound.coordinate_system != "object" && bound.coordinate_system != "current" &&
             bound.coordinate_system != "shader")
        warn_once("the displacement bound's coordinate system " + in_quotes(bound.coordinate_system) +
                      " is not known; object space is used",
                  "displacementbound-" + bound.coordinate_system);
    return bound.sphere * stretch;
}

std::shared_ptr<const Attributes> Reader::resolved_attributes(
    const std::shared_ptr<const AttributeState>& state, const std::vector<M44f>& camera_from_object) {
    // dPdu x dPdv in camera space is the transformed outward normal times the sign of the determinant.
    const bool mirrored = M44d(camera_from_object.front()).determinant() < 0;
    const bool inside = state->orientation == Orientation::Inside;
    const bool reverse = (mirrored != inside) != state->orientation_reversed;
    const float bound = displacement_length(*state, camera_from_object);
    if (resolved_.state == state && resolved_.attributes->reverse_orientation == reverse &&
        resolved_.attributes->displacement_bound == bound)
        return resolved_.attributes;
    auto attributes = std::make_shared<Attributes>(state->attributes);
    attributes->reverse_orientation = reverse;
    attributes->displacement_bound = bound;
    set_seen_numbers(*attributes, state->detail.seen());
    if (read_options_.shading_rate) attributes->shading_rate = *read_options_.shading_rate;
    resolved_ = {state, attributes};
    return attributes;
}

bool Reader::has_room(uint64_t bytes) {
    scene_bytes_ += bytes;
    if (scene_bytes_ <= read_options_.most_scene_bytes) return true;
    diagnostics_.error(at_,
                       request_name_ + ": the scene takes more than " +
                           std::to_string(read_options_.most_scene_bytes >> 20) +
                           " MiB, which is the limit; this and further primitives are left out",
                       "scene-limit");
    return false;
}

void Reader::emit(const std::string& request, std::vector<ShapePointer> shape_keys,
                  const MovingTransform& transform, const std::shared_ptr<const AttributeState>& state,
                  SourceLocation at, int solid) {
    const float open = scope_.options.shutter_open, close = scope_.options.shutter_close;
    Primitive primitive;
    primitive.location = at;
    primitive.solid = solid;
    primitive.shape_keys = std::move(shape_keys);
    const int keys = close > open ? keys_for_paths(transform, open, close, primitive.shape_keys,
                                                   make_camera(scope_.options))
                                  : 1;
    primitive.camera_from_object.reserve(static_cast<size_t>(keys));
    for (int k = 0; k < keys; ++k)
        primitive.camera_from_object.push_back(M44f(transform.at(key_time(open, close, k, keys))));
    const auto& spaces = primitive.camera_from_object;
    if (!std::all_of(spaces.begin(), spaces.end(), is_finite) ||
        !(std::abs(M44d(spaces.front()).determinant()) > 0)) {
        const std::string what = request == request_name_ ? "" : request + ": ";
        error(at, what + "the current transformation is singular; primitive skipped");
        return;
    }
    ++summary_.primitives[request];
    summary_.points += point_count(primitive.shape());
    if (primitive.key_count() > 1) ++summary_.moving_primitives;
    if (!keeps_geometry() || state->detail.seen().are_none()) return;
    const std::shared_ptr<const Attributes> last = resolved_.attributes;
    primitive.attributes = resolved_attributes(state, spaces);
    uint64_t bytes = bytes_of(primitive);
    if (primitive.attributes != last) bytes += bytes_of(*primitive.attributes);
    if (!has_room(bytes)) return;
    scene_.primitives.push_back(std::move(primitive));
}

/// Whether a scene or an object is open to take it. What stands before all worlds may be an archive, which is
/// said at the end of the input.
bool Reader::takes_geometry() {
    if (in_world_ || object_) return true;
    if (summary_.worlds > 0) throw RequestError{"geometry outside of a world", {}};
    if (homeless_.count++ == 0) homeless_.first = at_, homeless_.request = request_name_;
    return false;
}

/// Says what of takes_geometry() found no world, now that the first one begins, or none came.
void Reader::report_homeless() {
    if (homeless_.count == 0) return;
    const std::string count =
        homeless_.count == 1 ? "1 primitive" : std::to_string(homeless_.count) + " primitives";
    if (in_world_) {
        std::swap(request_name_, homeless_.request);
        error(homeless_.first, "geometry outside of a world; " + count + " skipped");
        std::swap(request_name_, homeless_.request);
    } else
        diagnostics_.note(
            homeless_.first,
            count + " outside of a world, in an input that has none: an archive for other files to read");
    homeless_.count = 0;
}

/// That which the archive being read has made before, where it is the same; null when there is no room for a
/// new one. Poses of a motion are counted at its end, at the keys that the scene has.
ShapePointer Reader::shared_or_new(Shape shape) {
    auto shared = std::make_shared<const Shape>(std::move(shape));
    if (place_.archive && place_.archive->share(place_.request, place_.shapes++, shared)) return shared;
    if (keeps_geometry() && !motion_ && !has_room(bytes_of(*shared))) return nullptr;
    return shared;
}

void Reader::add_shape(std::string request, Shape shape, uint64_t faces) {
    if (!takes_geometry()) return;
    if (motion_) {
        if (motion_->request.empty()) motion_->request = request;
        if (motion_->request != request)
            throw RequestError{"this is a motion block of " + motion_->request, {}};
    }
    summary_.faces += faces;
    place_emitter(shape);
    const ShapePointer shared = shared_or_new(std::move(shape));
    if (!shared) return;
    if (motion_)
        motion_->shapes.push_back(shared);
    else if (object_)
        object_->primitives.push_back({std::move(request),
                                       {shared},
                                       {0.0f},
                                       state_.transform,
                                       state_.attributes,
                                       at_,
                                       {},
                                       0,
                                       0,
                                       solid_of_surface(object_->solids)});
    else
        emit(request, only(shared), state_.transform, state_.attributes, at_, solid_of_surface(solids_));
}

ShaderInstance Reader::shader(ArgumentCursor& cursor, const char* kind) {
    ShaderInstance instance;
    instance.name = cursor.string("the shader's name");
    instance.location = at_;
    instance.camera_from_shader = camera_from_current();
    ++summary_.shaders[std::string(kind) + " " + instance.name];
    return instance;
}

void Reader::add_light(std::shared_ptr<const LightInstance> light) {
    if (object_) throw RequestError{"inside an object definition", {}};
    ++summary_.lights;
    scope_.lights[light->handle] = light;
    change_attributes().attributes.lights.push_back(std::move(light));
}

std::shared_ptr<const LightInstance> Reader::light(const std::string& handle) const {
    const auto found = scope_.lights.find(handle);
    return found == scope_.lights.end() ? nullptr : found->second;
}

}  // namespace trapeze::rib
