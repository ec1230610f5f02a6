/// The current graphics state, and the blocks that save and restore it (RISpec 4).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "pipeline/rib/state/declarations.h"
#include "pipeline/rib/state/graphics_state.h"
#include "pipeline/rib/state/saved_states.h"

namespace trapeze::rib {

/// Owns all that a request can set and a block can restore: transformation, attributes, options, named
/// spaces, lights and objects by their names. Knows nothing of scenes: who adds to one asks here for the
/// state to add it with.
class GraphicsStateStack {
  public:
    /// RISpec's defaults.
    GraphicsStateStack();

    /// For the transformation mainly: attributes are changed through change_attributes().
    GraphicsState& current() { return state_; }
    const GraphicsState& current() const { return state_; }
    const AttributeState& attributes() const { return *state_.attributes; }
    /// Copies the attributes first where primitives or blocks share them.
    AttributeState& change_attributes();
    /// The same, for what an object's definition then has of its own.
    AttributeState& change_attributes(Own what);

    /// What frames and worlds restore; a change holds until the innermost of them ends.
    Scope& scope() { return scope_; }
    const Scope& scope() const { return scope_; }
    Options& options() { return scope_.options; }
    const Options& options() const { return scope_.options; }
    /// Outside of all blocks: none restores them.
    Declarations& declarations() { return declarations_; }
    const Declarations& declarations() const { return declarations_; }

    // --- blocks ---
    /// Opens a block at the place of its request; frames and worlds save the scope too. The world's
    /// transformation is the camera's. Throws a RequestError inside a motion block, or when blocks nest too
    /// deeply.
    void open(BlockKind kind, SourceLocation at);
    /// Closes the innermost block and restores what it saved: of a transform block the transformation alone,
    /// of a motion block nothing.
    void close();
    bool is_open(BlockKind kind) const { return open_counts_[static_cast<size_t>(kind)] > 0; }
    /// All open blocks, the outermost first.
    const std::vector<OpenBlock>& blocks() const { return blocks_; }
    bool in_world() const { return is_open(BlockKind::World); }
    bool in_object() const { return is_open(BlockKind::Object); }
    /// No block opens within a motion block: it is the innermost.
    bool in_motion() const { return is_open(BlockKind::Motion); }

    // --- PRMan's Resource ---
    SavedStates& saved_states() { return saved_states_; }
    /// Takes over the attributes, the transformation or both from a saved state; false when there is none of
    /// that name.
    bool restore(const std::string& name, bool attributes, bool transform);

    // --- spaces; all transformations are camera_from_..., for row vectors ---
    /// The camera's transformation as the last world opened.
    const MovingTransform& camera_from_world() const { return camera_from_world_; }
    /// What Identity and Transform are relative to: the world in a world, the camera before it, and the
    /// object in its definition.
    MovingTransform root_transform() const;
    /// CoordinateSystem: the name lasts until the world ends. In an object it is for the object's shaders.
    void name_coordinate_system(const std::string& name);
    /// ScopedCoordinateSystem: the name ends with the block.
    void name_scoped_coordinate_system(const std::string& name);
    /// CoordSysTransform: throws a RequestError for unknown names.
    void use_coordinate_system(const std::string& name);
    /// Null when there is none of that name, neither among `scoped` nor for all.
    const MovingTransform* named_space(const std::string& name, const NamedSpaces* scoped) const;
    /// CoordinateSystem of the object that is being defined, in its space.
    const NamedSpaces& object_spaces() const { return object_spaces_; }
    /// The current space as the shutter opens.
    M44f camera_from_current() const;
    /// The same at kHeldKeys keys of the shutter; empty where nothing moves it then.
    std::vector<M44f> moving_current() const;
    /// Handedness of the current space as the shutter opens. Camera space is left-handed (RISpec 4.1.1).
    bool is_right_handed() const;
    /// Pixels of the smallest upright rectangle round a box of the current space (xmin xmax ymin ymax zmin
    /// zmax) on the picture, times RelativeDetail (RISpec 4.2.7). Infinite in an object's definition, whose
    /// instances may be of any size.
    float raster_area(const std::vector<float>& bound) const;

  private:
    GraphicsState state_;
    Scope scope_;
    Declarations declarations_;
    SavedStates saved_states_;
    MovingTransform camera_from_world_;
    NamedSpaces object_spaces_;
    std::vector<OpenBlock> blocks_;
    std::array<size_t, kBlockKinds> open_counts_{};  ///< by BlockKind
    uint64_t block_count_ = 0;                       ///< since the beginning, for the blocks' ids
};

}  // namespace trapeze::rib
