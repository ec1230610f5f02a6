/// What the reader puts into scenes: primitives with their motion resolved to even keys, lights, shaders,
/// parameters.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "pipeline/rib/reader.h"

namespace trapeze::rib {
namespace {

bool same_variables(const Shape& a, const Shape& b) {
    if (a.variables.values.size() != b.variables.values.size()) return false;
    for (size_t i = 0; i < a.variables.values.size(); ++i) {
        const Parameter &x = a.variables.values[i], &y = b.variables.values[i];
        if (x.name != y.name || x.declaration != y.declaration || x.floats.size() != y.floats.size())
            return false;
    }
    return true;
}

struct SameTopology {
    bool operator()(const PolygonMesh& a, const PolygonMesh& b) const {
        return a.loops_per_polygon == b.loops_per_polygon && a.vertices_per_loop == b.vertices_per_loop &&
               a.vertices == b.vertices && a.vertex_count == b.vertex_count;
    }
    bool operator()(const SubdivisionMesh& a, const SubdivisionMesh& b) const {
        return a.scheme == b.scheme && a.vertices_per_face == b.vertices_per_face &&
               a.vertices == b.vertices && a.vertex_count == b.vertex_count && a.tags.size() == b.tags.size();
    }
    bool operator()(const Quadric& a, const Quadric& b) const {
        return a.kind == b.kind && a.value_count == b.value_count;
    }
    bool operator()(const PatchMesh& a, const PatchMesh& b) const {
        return a.bicubic == b.bicubic && a.nu == b.nu && a.nv == b.nv && a.u_wraps == b.u_wraps &&
               a.v_wraps == b.v_wraps && a.u_step == b.u_step && a.v_step == b.v_step;
    }
    template <class A, class B>
    bool operator()(const A&, const B&) const {
        return false;
    }
};

bool can_deform(const Shape& a, const Shape& b) {
    return std::visit(SameTopology{}, a.topology, b.topology) && same_variables(a, b);
}

/// Everything that is a number, interpolated.
std::shared_ptr<const Shape> between(const Shape& a, const Shape& b, float t) {
    auto shape = std::make_shared<Shape>(a);
    if (auto* quadric = std::get_if<Quadric>(&shape->topology)) {
        const auto& end = std::get<Quadric>(b.topology);
        for (int i = 0; i < quadric->value_count; ++i)
            quadric->values[i] += t * (end.values[i] - quadric->values[i]);
    }
    for (size_t i = 0; i < shape->variables.values.size(); ++i) {
        std::vector<float>& values = shape->variables.values[i].floats;
        const std::vector<float>& end = b.variables.values[i].floats;
        for (size_t k = 0; k < values.size(); ++k) values[k] += t * (end[k] - values[k]);
    }
    return shape;
}

std::shared_ptr<const Shape> shape_at(const std::vector<std::shared_ptr<const Shape>>& shapes,
                                      const std::vector<float>& times, float time) {
    if (shapes.size() == 1 || time <= times.front()) return shapes.front();
    if (time >= times.back()) return shapes.back();
    const size_t next = std::upper_bound(times.begin(), times.end(), time) - times.begin();
    const float t = (time - times[next - 1]) / (times[next] - times[next - 1]);
    if (t == 0) return shapes[next - 1];
    return between(*shapes[next - 1], *shapes[next], t);
}

float key_time(float open, float close, int key, int keys) {
    return keys == 1 ? open
                     : open + (close - open) * (static_cast<float>(key) / static_cast<float>(keys - 1));
}

size_t point_count(const Shape& shape) {
    const VariableCounts counts = variable_counts(shape.topology);
    return std::holds_alternative<Quadric>(shape.topology) ? 0 : static_cast<size_t>(counts.vertex);
}

}  // namespace

float Reader::displacement_length(const AttributeState& attributes, const M44f& camera_from_object) const {
    const DisplacementBound& bound = attributes.displacement_bound;
    if (bound.sphere == 0) return 0;
    M44f space = camera_from_object;
    if (bound.coordinate_system == "camera")
        space = M44f();
    else if (bound.coordinate_system != "object" && bound.coordinate_system != "shader")
        if (const auto named = named_spaces_.find(bound.coordinate_system); named != named_spaces_.end())
            space = M44f(named->second.at(options_.shutter_open));
    // A sphere becomes an ellipsoid: its longest axis is at most the length of the three together.
    float scale = 0;
    for (int i = 0; i < 3; ++i) scale += V3f(space[i][0], space[i][1], space[i][2]).length2();
    return bound.sphere * std::sqrt(scale);
}

void Reader::emit(const std::string& request, const std::vector<std::shared_ptr<const Shape>>& shapes,
                  const std::vector<float>& times, const MovingTransform& transform,
                  const AttributeState& state, SourceLocation at) {
    const float open = options_.shutter_open, close = options_.shutter_close;
    const bool shutter = close > open;
    const std::string what = request == request_name_ ? "" : request + ": ";
    Primitive primitive;
    primitive.location = at;

    bool deforms = shutter && shapes.size() > 1 && close > times.front() && open < times.back();
    for (const auto& shape : shapes)
        if (!can_deform(*shapes.front(), *shape)) {
            error(at, what + "the shapes of the motion differ in topology or variables; the first is used");
            deforms = false;
            primitive.shape_keys.push_back(shapes.front());
            break;
        }
    if (primitive.shape_keys.empty()) {
        const int keys = deforms ? keys_meeting(times, open, close) : 1;
        for (int k = 0; k < keys; ++k)
            primitive.shape_keys.push_back(shape_at(shapes, times, key_time(open, close, k, keys)));
    }
    const int keys = shutter ? transform.wanted_keys(open, close) : 1;
    for (int k = 0; k < keys; ++k)
        primitive.camera_from_object.push_back(M44f(transform.at(key_time(open, close, k, keys))));

    const M44f& space = primitive.camera_from_object.front();
    const double handedness = M44d(space).determinant();
    if (!(std::abs(handedness) > 0) || !std::isfinite(handedness)) {
        error(at, what + "the current transformation is singular; primitive skipped");
        return;
    }
    auto attributes = std::make_shared<Attributes>(state.attributes);
    // dPdu x dPdv in camera space is the transformed outward normal times the sign of the determinant.
    const bool mirrored = handedness < 0;
    const bool inside = state.orientation == Orientation::Inside ||
                        (state.orientation == Orientation::LeftHanded && mirrored) ||
                        (state.orientation == Orientation::RightHanded && !mirrored);
    attributes->reverse_orientation = (mirrored != inside) != state.orientation_reversed;
    attributes->displacement_bound = displacement_length(state, space);
    if (read_options_.shading_rate) attributes->shading_rate = *read_options_.shading_rate;
    primitive.attributes = std::move(attributes);

    ++summary_.primitives[request];
    summary_.points += point_count(*shapes.front());
    if (primitive.key_count() > 1) ++summary_.moving_primitives;
    if (read_options_.keep_geometry) scene_.primitives.push_back(std::move(primitive));
}

void Reader::add_shape(std::string request, Shape shape, uint64_t faces) {
    summary_.faces += faces;
    auto shared = std::make_shared<const Shape>(std::move(shape));
    if (motion_) {
        if (motion_->request.empty()) motion_->request = request;
        if (motion_->request != request || !motion_->transforms.empty())
            throw RequestError{"a motion block of " + motion_->request, {}};
        motion_->shapes.push_back(std::move(shared));
        return;
    }
    if (object_being_defined_) {
        objects_[*object_being_defined_].push_back(
            {std::move(request), {std::move(shared)}, {0.0f}, state_.transform, state_.attributes, at_});
        return;
    }
    if (!in_world_) throw RequestError{"geometry outside of a world", {}};
    emit(request, {std::move(shared)}, {0.0f}, state_.transform, *state_.attributes, at_);
}

void Reader::begin_object(const std::string& handle) {
    if (object_being_defined_) throw RequestError{"object definitions do not nest", {}};
    begin_block(Block::Object);
    object_being_defined_ = handle;
    objects_[handle].clear();
    object_attributes_ = state_.attributes;
    state_.transform = MovingTransform();
}

void Reader::end_object() {
    if (!object_being_defined_) {
        error("no ObjectBegin is open; ignored");
        return;
    }
    for (ObjectPrimitive& primitive : objects_[*object_being_defined_])
        if (primitive.attributes == object_attributes_) primitive.attributes = nullptr;
    object_being_defined_.reset();
    object_attributes_ = nullptr;
    end_block(Block::Object, "ObjectEnd");
}

void Reader::instance(const std::string& handle) {
    const auto object = objects_.find(handle);
    if (object == objects_.end()) throw RequestError{"no object \"" + handle + "\"", {}};
    if (object_being_defined_) throw RequestError{"inside an object definition", {}};
    if (!in_world_) throw RequestError{"outside of a world", {}};
    for (const ObjectPrimitive& primitive : object->second) {
        MovingTransform transform = state_.transform;
        transform.concat(primitive.object_from_shape);
        emit(primitive.request, primitive.shapes, primitive.times, transform,
             primitive.attributes ? *primitive.attributes : *state_.attributes, at_);
    }
}

ParameterList Reader::parameters(ArgumentCursor& cursor) {
    ParameterList list;
    while (!cursor.done()) {
        if (!cursor.next_is_string() || cursor.peek()->strings.size() != 1)
            throw RequestError{"a parameter's name is expected", cursor.peek()->at};
        const SourceLocation name_at = cursor.peek()->at;
        const std::string token = cursor.string("a parameter's name");
        if (cursor.done()) throw RequestError{"\"" + token + "\" has no value", name_at};
        Argument value = cursor.take("a value");
        // Several bare numbers may stand for an array of a fixed size (a colour, say).
        while (value.kind != Argument::Kind::Array && !value.numbers.empty() && cursor.next_is_number() &&
               cursor.peek()->kind == Argument::Kind::Number)
            value.numbers.push_back(cursor.number("a value"));
        const auto declared = declarations_.resolve(token);
        if (!declared) {
            diagnostics_.error(name_at, request_name_ + ": \"" + token + "\" is not declared; left out",
                               "undeclared-" + token);
            continue;
        }
        const auto& [name, declaration] = *declared;
        const bool is_string = declaration.type == ValueType::String;
        if ((is_string && !value.numbers.empty()) || (!is_string && !value.strings.empty())) {
            error(name_at, "\"" + name + "\" wants " + (is_string ? "strings" : "numbers") + "; left out");
            continue;
        }
        const size_t got = is_string ? value.strings.size() : value.numbers.size();
        const size_t item = is_string ? declaration.array_length : declaration.floats_per_item();
        if (got == 0 || got % item != 0) {
            error(name_at, "\"" + name + "\" has " + std::to_string(got) + " values, needs a multiple of " +
                               std::to_string(item) + "; left out");
            continue;
        }
        list.set({name, declaration, std::move(value.numbers), std::move(value.strings)});
    }
    return list;
}

std::shared_ptr<const ShaderInstance> Reader::shader(ArgumentCursor& cursor, const char* kind) {
    auto instance = std::make_shared<ShaderInstance>();
    instance->name = cursor.string("the shader's name");
    instance->location = at_;
    instance->parameters = parameters(cursor);
    instance->camera_from_shader = camera_from_current();
    ++summary_.shaders[std::string(kind) + " " + instance->name];
    if (motion_ && motion_->others++ > 0) return nullptr;
    return instance;
}

void Reader::add_light(std::shared_ptr<const LightInstance> light) {
    ++summary_.lights;
    lights_[light->handle] = light;
    change_attributes().attributes.lights.push_back(std::move(light));
}

std::shared_ptr<const LightInstance> Reader::light(const std::string& handle) const {
    const auto found = lights_.find(handle);
    return found == lights_.end() ? nullptr : found->second;
}

void Reader::set_search_path(const std::string& category, const std::string& path) {
    std::vector<std::string>& folders = options_.search_paths[category];
    const std::vector<std::string> previous = std::move(folders);
    folders.clear();
    const std::filesystem::path here = std::filesystem::path(current_file()).parent_path();
    size_t begin = 0;
    while (begin <= path.size()) {
        const size_t end = std::min(path.find(':', begin), path.size());
        std::string folder = path.substr(begin, end - begin);
        begin = end + 1;
        if (folder == "&") {
            folders.insert(folders.end(), previous.begin(), previous.end());
            continue;
        }
        if (folder.empty() || folder == "@") continue;  // the renderer's standard places need no naming
        if (folder[0] == '$' || folder.front() == '%') {
            const size_t stop = folder.front() == '%' ? folder.find('%', 1) : folder.find_first_of("/", 1);
            const char* value =
                std::getenv(folder.substr(1, stop == std::string::npos ? stop : stop - 1).c_str());
            const size_t rest =
                stop == std::string::npos ? folder.size() : stop + (folder.front() == '%' ? 1 : 0);
            folder = (value ? value : "") + folder.substr(rest);
        }
        const std::filesystem::path p(folder);
        folders.push_back(p.is_absolute() ? folder : (here / p).string());
        if (!p.is_absolute()) folders.push_back(folder);
    }
}

}  // namespace trapeze::rib
