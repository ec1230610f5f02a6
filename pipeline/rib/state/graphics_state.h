/// The graphics state of RISpec 4: what blocks save and restore.
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/level_of_detail.h"
#include "core/scene/scene.h"
#include "pipeline/rib/ris/ris_network.h"
#include "pipeline/rib/state/block_kind.h"
#include "pipeline/rib/state/moving_transform.h"
#include "pipeline/rib/state/own_attributes.h"
#include "pipeline/rib/syntax/arguments.h"

namespace trapeze::rib {

/// Attribute "displacementbound", resolved when a primitive takes it.
struct DisplacementBound {
    float sphere = 0;
    std::string coordinate_system = "object";

    bool operator==(const DisplacementBound&) const = default;
};

/// Whether the current orientation matches that of the current coordinate system (outside): it goes on
/// matching, or not matching, whatever transformations reflect, for both flip together (RISpec 4.2). In an
/// object's definition that has not said it is what the instance has.
enum class Orientation { OfInstance, Outside, Inside };

/// Detail and DetailRange (RISpec 4.2.7). Sizes are areas of the picture in pixels, RelativeDetail included.
struct Detail {
    float size = std::numeric_limits<float>::infinity();  ///< of the bound; infinite: none was given
    float least = 0, full_from = 0;                       ///< grows in between
    float full_to = std::numeric_limits<float>::infinity(), most = full_to;  ///< fades in between

    /// The part of the samples that see the primitive at this size.
    SeenNumbers seen() const;
};

/// A light that shines from the shapes after it.
struct Emitter {
    std::shared_ptr<LightInstance> light;
    bool is_of_ris = false;  ///< else an AreaLightSource of RSL
    bool is_placed = false;  ///< the first has come
};

/// What AttributeBegin saves but for the transformation: the attributes that primitives take with them, and
/// those that only shape what is read (bases, trims, detail). Shared and copied on write
/// (GraphicsStateStack::change_attributes()).
struct AttributeState {
    Attributes attributes;
    Detail detail;
    DisplacementBound displacement_bound;
    Orientation orientation = Orientation::Outside;
    bool orientation_reversed = false;
    M44f u_basis, v_basis;
    int u_step = 3, v_step = 3;
    std::shared_ptr<const std::vector<std::vector<TrimCurve>>> trim_loops;  ///< null: none
    bool trim_outside = false;
    std::shared_ptr<Emitter> emitter;  ///< null: none
    uint64_t asset_block = 0;          ///< the block that has named Attributes::asset
    OwnAttributes own;                 ///< kept while an object is defined
};

using NamedSpaces = std::map<std::string, MovingTransform>;  ///< camera_from_space

/// What each block saves: three shared pointers, cheap to copy however much they hold.
struct GraphicsState {
    MovingTransform transform;  ///< camera_from_current
    std::shared_ptr<const AttributeState> attributes;
    std::shared_ptr<const NamedSpaces> scoped_spaces;  ///< ScopedCoordinateSystem; null: none
};

/// The request that opens it.
const char* block_name(BlockKind kind);

/// Solids as they are defined, and which is open.
struct SolidList {
    std::vector<Solid> solids;
    std::vector<int> children;  ///< how many each has
    int open = -1;              ///< -1: none

    /// Throws a RequestError when there are too many.
    int add(Solid::Operation operation, int parent);
};

/// A primitive as an object definition keeps it: placed by each instance.
struct ObjectPrimitive {
    std::string request;
    std::vector<std::shared_ptr<const Shape>> shapes;
    std::vector<float> times;
    MovingTransform object_from_shape;
    std::shared_ptr<const AttributeState>
        attributes;  ///< what ObjectBegin's record has (AttributeState::own) outdoes the instance's
    SourceLocation at;
    /// `shapes` at the keys of the shutter, made by the first instance for all.
    std::vector<std::shared_ptr<const Shape>> keys;
    float keys_open = 0, keys_close = 0;
    int solid = -1;                             ///< of the object's
    std::shared_ptr<const NamedSpaces> spaces;  ///< ScopedCoordinateSystem of the definition; null: none
};

/// An object between ObjectBegin and ObjectEnd, and as instances find it. Its primitives stand in the
/// object's own space, which has no camera.
struct RetainedObject {
    std::shared_ptr<const AttributeState> attributes;  ///< at ObjectBegin
    std::vector<ObjectPrimitive> primitives;
    std::vector<std::shared_ptr<const LightInstance>> lights;  ///< of RIS; in the object's space
    SolidList solids;
    NamedSpaces named_spaces;  ///< CoordinateSystem of the definition
};

/// A channel that modes of Displays may name.
struct DisplayChannel {
    DisplayVariable variable;
    ParameterList parameters;
};

/// ClippingPlane: what is on the side to which the normal points is cut away. Kept with its motion until the
/// world is delivered, as the shutter may change.
struct ReadPlane {
    MovingTransform transform;  ///< camera_from_plane
    V3d point, normal;

    /// The plane in camera space, with a unit normal that points to what stays. False where its space is
    /// singular.
    bool at(float time, ClippingPlane::Key& key) const;
    /// As scenes have it.
    ClippingPlane in_shutter(float open, float close) const;
};

/// ColorSamples (RISpec 4.1.4): colours of n samples, and their matrix of n rows of red, green, blue.
struct ColorSamples {
    size_t samples = 0;
    std::vector<float> rgb_from_samples;
};

/// What frames and worlds restore besides the graphics state: RISpec ends the life of lights, objects and
/// options with them.
struct Scope {
    Options options;
    NamedSpaces named_spaces;
    std::vector<ReadPlane> clipping_planes;
    std::optional<ColorSamples> color_samples;
    float relative_detail = 1;
    bool has_pixel_samples = false;  ///< PixelSamples was given: a hider's sample counts are not looked at
    bool has_projection = false;     ///< Projection was given
    std::map<std::string, SourceLocation> quantized;  ///< types that Quantize has named
    std::map<std::string, std::shared_ptr<const LightInstance>> lights;
    std::vector<std::shared_ptr<const Emitter>> emitters;  ///< of RSL, that no Illuminate has named
    std::map<std::string, DisplayChannel> display_channels;
    std::map<std::string, std::shared_ptr<RetainedObject>> objects;
    RisNetwork ris;

    /// Numbers of one colour in the file; 3 but for ColorSamples.
    size_t samples_per_color() const { return color_samples ? color_samples->samples : 3; }
    /// Colours as the file gives them, as RGB.
    std::vector<float> rgb(std::vector<float> colors) const;
};

/// A block that is open, with what its end restores. The id tells it from a later block at the same depth.
struct OpenBlock {
    BlockKind kind = BlockKind::Attribute;
    uint64_t id = 0;  ///< no other block's
    SourceLocation at;
    GraphicsState saved;
    std::unique_ptr<Scope> scope;  ///< of frames and worlds
};

}  // namespace trapeze::rib
