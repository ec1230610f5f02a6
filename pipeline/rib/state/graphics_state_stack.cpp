#include "pipeline/rib/state/graphics_state_stack.h"

#include "core/scene/poses.h"
#include "pipeline/rib/state/bases.h"
#include "shade/materials/picture_spaces.h"

namespace trapeze::rib {
namespace {

constexpr size_t kDeepestBlock = 10000;  ///< each saves a state: files that only open blocks must end

/// The structures start with RISpec's defaults, but for the bases, whose matrix has to be made.
std::shared_ptr<const AttributeState> default_attributes() {
    auto state = std::make_shared<AttributeState>();
    state->u_basis = state->v_basis = bezier_basis();
    return state;
}

}  // namespace

const char* block_name(BlockKind kind) {
    switch (kind) {
        case BlockKind::Frame:
            return "FrameBegin";
        case BlockKind::World:
            return "WorldBegin";
        case BlockKind::Attribute:
            return "AttributeBegin";
        case BlockKind::Transform:
            return "TransformBegin";
        case BlockKind::Motion:
            return "MotionBegin";
        case BlockKind::Object:
            return "ObjectBegin";
        case BlockKind::Solid:
            return "SolidBegin";
    }
    return "";
}

/// Row vectors: a colour of n samples times the matrix of n rows (RISpec 4.1.4).
std::vector<float> Scope::rgb(std::vector<float> colors) const {
    if (!color_samples) return colors;
    const auto& [n, matrix] = *color_samples;
    std::vector<float> converted(colors.size() / n * 3);
    for (size_t color = 0; color < colors.size() / n; ++color)
        for (size_t i = 0; i < n; ++i)
            for (size_t k = 0; k < 3; ++k)
                converted[color * 3 + k] += colors[color * n + i] * matrix[i * 3 + k];
    return converted;
}

GraphicsStateStack::GraphicsStateStack() {
    state_.attributes = default_attributes();
}

/// Copy on write: thousands of blocks and primitives share one state, and most change little of it. The only
/// owner may write where it stands.
AttributeState& GraphicsStateStack::change_attributes() {
    if (state_.attributes.use_count() > 1)
        state_.attributes = std::make_shared<AttributeState>(*state_.attributes);
    return const_cast<AttributeState&>(*state_.attributes);
}

AttributeState& GraphicsStateStack::change_attributes(Own what) {
    AttributeState& state = change_attributes();
    if (in_object()) state.own.set(what);
    return state;
}

/// States are shared and not copied: a block saves three pointers, but for frames and worlds.
void GraphicsStateStack::open(BlockKind kind, SourceLocation at) {
    if (in_motion()) throw RequestError{"inside a motion block", {}};
    if (blocks_.size() >= kDeepestBlock)
        throw RequestError{"blocks are nested more than " + std::to_string(kDeepestBlock) + " deep", {}};
    OpenBlock& block = blocks_.emplace_back();
    block.kind = kind, block.id = ++block_count_, block.at = at, block.saved = state_;
    ++open_counts_[static_cast<size_t>(kind)];
    if (kind == BlockKind::Frame || kind == BlockKind::World) block.scope = std::make_unique<Scope>(scope_);
    if (kind == BlockKind::Object) object_spaces_.clear();
    if (kind == BlockKind::World) scope_.named_spaces["world"] = camera_from_world_ = state_.transform;
}

/// A motion block restores nothing: what it holds is there to change the state around it.
void GraphicsStateStack::close() {
    OpenBlock block = std::move(blocks_.back());
    blocks_.pop_back();
    --open_counts_[static_cast<size_t>(block.kind)];
    if (block.scope) scope_ = std::move(*block.scope);
    if (block.kind == BlockKind::Motion) return;
    if (block.kind == BlockKind::Transform)  // attributes that changed since stay
        state_.transform = std::move(block.saved.transform);
    else
        state_ = std::move(block.saved);
}

/// A saved state outlives the block that it was saved in. Scoped names of coordinate systems stay what they
/// are. In an object's definition all that comes from outside of it is the object's own.
bool GraphicsStateStack::restore(const std::string& name, bool attributes, bool transform) {
    if (in_motion()) throw RequestError{"inside a motion block", {}};
    const GraphicsState* const saved = saved_states_.find(name);
    if (!saved) return false;
    if (attributes) {
        const uint64_t definition = state_.attributes->own.definition();
        state_.attributes = saved->attributes;
        if (in_object() && state_.attributes->own.definition() != definition)
            change_attributes().own = OwnAttributes(definition, saved->attributes);
    }
    if (transform) state_.transform = saved->transform;
    return true;
}

/// Inside of an object a transformation is relative to the object, though a world may be open around it.
MovingTransform GraphicsStateStack::root_transform() const {
    return in_world() && !in_object() ? camera_from_world_ : MovingTransform();
}

/// Kept with its motion, and taken as the shutter opens only when the world is delivered: until WorldBegin
/// the shutter may change.
void GraphicsStateStack::name_coordinate_system(const std::string& name) {
    (in_object() ? object_spaces_ : scope_.named_spaces)[name] = state_.transform;
}

/// Copied on each new name: saved states share the map, and scenes name few.
void GraphicsStateStack::name_scoped_coordinate_system(const std::string& name) {
    auto spaces = state_.scoped_spaces ? std::make_shared<NamedSpaces>(*state_.scoped_spaces)
                                       : std::make_shared<NamedSpaces>();
    (*spaces)[name] = state_.transform;
    state_.scoped_spaces = std::move(spaces);
    // Shaders elsewhere know the first of a name, unless there is one for all.
    if (!in_object()) scope_.named_spaces.try_emplace(name, state_.transform);
}

/// Scoped names hide others.
const MovingTransform* GraphicsStateStack::named_space(const std::string& name,
                                                       const NamedSpaces* scoped) const {
    if (scoped)
        if (const auto space = scoped->find(name); space != scoped->end()) return &space->second;
    const auto space = scope_.named_spaces.find(name);
    return space == scope_.named_spaces.end() ? nullptr : &space->second;
}

/// Some names are known without a definition: in "camera" nothing has been transformed, and where the camera
/// sees in parallel, "screen", "NDC" and "raster" are scales and shifts of it, as options have them now.
void GraphicsStateStack::use_coordinate_system(const std::string& name) {
    if (in_motion()) throw RequestError{"inside a motion block", {}};
    if (in_object()) throw RequestError{"inside an object definition", {}};
    if (const MovingTransform* const space = named_space(name, state_.scoped_spaces.get())) {
        state_.transform = *space;
        return;
    }
    const Camera camera = make_camera(scope_.options);
    const std::optional<M44d> of_picture = camera_from_picture(camera, name);
    if (of_picture && camera.perspective)
        throw RequestError{in_quotes(name) + " of a perspective camera is no transformation of surfaces", {}};
    if (!of_picture && name != "camera") throw RequestError{"no coordinate system " + in_quotes(name), {}};
    state_.transform = MovingTransform();
    if (of_picture) state_.transform.concat(*of_picture);
}

/// Row vectors: p_camera = p_current * M.
M44f GraphicsStateStack::camera_from_current() const {
    return M44f(state_.transform.at(scope_.options.shutter_open));
}

std::vector<M44f> GraphicsStateStack::moving_current() const {
    std::vector<M44f> keys;
    const float open = scope_.options.shutter_open, close = scope_.options.shutter_close;
    if (!state_.transform.moves_between(open, close)) return keys;
    for (int key = 0; key < kHeldKeys; ++key) {
        const float part = static_cast<float>(key) / (kHeldKeys - 1);
        keys.emplace_back(state_.transform.at(open + part * (close - open)));
    }
    return keys;
}

/// A negative determinant turns left-handed camera space into a right-handed one.
bool GraphicsStateStack::is_right_handed() const {
    const float open = scope_.options.shutter_open;
    bool right = state_.transform.at(open).determinant() < 0;
    // An object's own space stands in that in which its definition began.
    for (const OpenBlock& block : blocks_)
        if (block.kind == BlockKind::Object && block.saved.transform.at(open).determinant() < 0)
            right = !right;
    return right;
}

}  // namespace trapeze::rib
