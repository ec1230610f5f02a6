/// What one WorldBegin/WorldEnd block describes, resolved by the RIB border: options, camera, lights,
/// primitives. Everything here is valid; later stages may rely on it.
#pragma once

#include <algorithm>
#include <cctype>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics.h"
#include "core/math.h"
#include "core/motion_keys.h"
#include "core/scene/light_shape.h"
#include "core/scene/parameters.h"
#include "core/scene/poses.h"
#include "core/scene/shapes.h"
#include "core/scene/user_values.h"

namespace trapeze {

/// RISpec's RI_INFINITY: the default far clipping plane, and the depth of an empty pixel.
inline constexpr float kInfinity = 1e30f;
inline constexpr float kEpsilon = 1e-10f;  ///< RISpec's RI_EPSILON: the default near clipping plane

/// What a pixel has of a variable: its samples filtered as the picture's colours are; of the samples in the
/// pixel that see a surface the least or greatest value, by channel; or of the surface in front of one
/// sample, that which sees the nearest or the farthest one.
enum class VariableFilter : uint8_t { Picture, Min, Max, Nearest, Farthest };

/// A variable of the surfaces that a Display shows: a float, colour, point, vector or normal.
struct DisplayVariable {
    std::string name;
    ValueType type = ValueType::Color;
    VariableFilter filter = VariableFilter::Picture;
};

/// A picture to be written, as a Display request asks for it.
struct Display {
    std::string name;  ///< without the leading '+'
    std::string type;  ///< driver: file, tiff, openexr, exr, png, framebuffer, ...
    std::string mode;  ///< rgb, rgba, a, z, rgbaz, or "varying color foo"
    ParameterList parameters;
    SourceLocation location;
    std::optional<DisplayVariable> variable =
        {};                  ///< what the mode names, unless it is colour, alpha or depth
    std::string layer = {};  ///< of the variable in a file of several displays; empty: the variable's name

    /// Whether the driver is the one of this name, given in lower case; the case of drivers does not count.
    bool has_driver(std::string_view driver) const {
        return std::ranges::equal(type, driver, {}, [](unsigned char c) { return std::tolower(c); });
    }
};

/// A PixelFilter request: the filter's name, and how wide it is.
struct PixelFilter {
    std::string name = "gaussian";
    float width_x = 2, width_y = 2;  ///< pixels, the whole support
};

/// ConnectShaderLayers: an output of one layer becomes a parameter of a later one.
struct LayerConnection {
    std::string from_layer, from_variable, to_layer, to_variable;
};

/// A shader as the scene names it. Parameters are in `parameters`; points among them are in shader space.
struct ShaderInstance {
    std::string name;
    ParameterList parameters;
    M44f camera_from_shader;  ///< at shutter open
    SourceLocation location;
    /// Coordinate systems that it sees before Scene::camera_from_named, at shutter open: those of its part of
    /// the world. Null: none.
    std::shared_ptr<const std::map<std::string, M44f>> camera_from_scoped;

    /// ShaderLayer: this is the last of several layers, which run in order; the earlier ones have none of
    /// their own. Connections may name any of them.
    std::string layer;
    std::vector<std::shared_ptr<const ShaderInstance>> earlier_layers;
    std::vector<LayerConnection> connections;
};

/// The options of RISpec 4.1, tables 4.1 and 4.2, with their defaults.
struct Options {
    int frame = 0;
    int width = 640, height = 480;
    float pixel_aspect = 1;
    std::optional<float> frame_aspect;
    std::optional<std::array<float, 4>> screen_window;  ///< left right bottom top
    /// Of x and y: screen = projected * scale + offset, of transformations before Projection. No scale is 0.
    std::array<float, 2> screen_scale{1, 1}, screen_offset{0, 0};
    std::array<float, 4> crop_window{0, 1, 0, 1};      ///< xmin xmax ymin ymax, fractions of the raster
    std::string projection = "orthographic";           ///< or "perspective"
    float fov = 90;                                    ///< degrees
    float near_clip = kEpsilon, far_clip = kInfinity;  ///< camera-space z
    float f_stop = kInfinity, focal_length = 0, focal_distance = 0;  ///< infinite f_stop: pinhole
    float shutter_open = 0, shutter_close = 0;
    float samples_x = 2, samples_y = 2;
    float pixel_variance = 0;  ///< PixelVariance: the variance that pixels are to have
    bool adaptive = false;     ///< pixels may stop at fewer samples where they have it
    float least_samples = 0;   ///< that they take along each axis first; 0: nobody says (adaptive_sampling.h)
    PixelFilter filter;
    float exposure_gain = 1, exposure_gamma = 1;
    int max_ray_depth = 10;  ///< Option "trace" "maxdepth": bounces of a ray
    int ray_levels = 0;      ///< Option "trace" "levels" of geometry that rays meet; 0: as many as pay
    ParameterList quantize;  ///< kept
    std::shared_ptr<const ShaderInstance> imager;  ///< null: none
    std::shared_ptr<const ShaderInstance> glow;    ///< Imager "glow" (glow.h), beside an imager; null: none
    std::string hider = "hidden";
    ParameterList hider_parameters;
    std::vector<Display> displays;  ///< the first is the primary one; others came with '+'
    UserValues user;                ///< Option "category" "name" value, by category
    std::map<std::string, std::vector<std::string>>
        search_paths;                     ///< by category; "." and the scene's folder included
    SourceLocation colors_location = {};  ///< of the last Option "ocio"
};

/// A light that a scene has made. Its shader sees its space at shutter open.
struct LightInstance {
    std::string handle;
    ShaderInstance shader;
    /// Of a shape that moves by itself or with the camera: shader.camera_from_shader at kHeldKeys evenly
    /// spaced keys of the shutter. Empty: it does not.
    std::vector<M44f> moving_space = {};
    std::optional<LightShape> shape = {};  ///< what it shines from; nothing: its shader knows
};

/// How rays that shaders trace meet a primitive. Nothing is seen by them unless its attributes ask for it, as
/// in PRMan.
struct RayAttributes {
    /// What a hit stands for: the primitive's own colour and opacity, or what its shaders make of them; or,
    /// for transmission alone, something that hides all.
    enum class HitMode : uint8_t { Primitive, Shader, Opaque };

    bool diffuse = false, specular = false, transmission = false;  ///< Attribute "visibility", by kind of ray
    HitMode transmission_hits = HitMode::Shader;  ///< Attribute "shade" "transmissionhitmode"
    HitMode specular_hits = HitMode::Shader;      ///< Attribute "shade" "specularhitmode"
    /// Attribute "shade" "diffusehitmode"; without it occlusion takes the primitive's own opacity, and
    /// colours are the shader's.
    std::optional<HitMode> diffuse_hits;
    float bias = 0;          ///< Attribute "trace" "bias", camera-space length; 0: follows from the dicing
    int max_diffuse = 1;     ///< Attribute "trace" "maxdiffusedepth": bounces
    int max_specular = 2;    ///< Attribute "trace" "maxspeculardepth"
    bool displaced = false;  ///< Attribute "trace" "displacements": rays meet what displacement shaders made
    /// Attribute "trace" "samplemotion": rays that leave the surface meet the scene at times of their own in
    /// the shutter, else as it opens.
    bool sample_motion = false;
    std::vector<std::string> groups;  ///< Attribute "grouping" "membership" (ray_groups.h)

    bool seen() const { return diffuse || specular || transmission; }
    bool operator==(const RayAttributes&) const = default;
};

/// The attributes of RISpec table 4.7 onwards: the graphics state attached to each primitive.
struct Attributes {
    V3f color{1, 1, 1};
    V3f opacity{1, 1, 1};
    std::array<float, 8> texture_coordinates{0, 0, 1, 0, 0, 1, 1, 1};  ///< s1 t1 .. s4 t4
    float shading_rate = 1;                                            ///< pixel area of a micropolygon
    bool smooth_shading = false;                                       ///< ShadingInterpolation "smooth"
    int matte = 0;
    int sides = 2;
    bool reverse_orientation =
        false;  ///< normals are flipped: Orientation, ReverseOrientation and a mirrored space
    std::shared_ptr<const ShaderInstance> surface;                         ///< null: defaultsurface
    std::shared_ptr<const ShaderInstance> displacement;                    ///< may be null
    std::shared_ptr<const ShaderInstance> atmosphere, interior, exterior;  ///< kept
    std::vector<std::shared_ptr<const LightInstance>> lights;              ///< lights that are switched on
    float displacement_bound = 0;                                          ///< camera-space length
    std::string name;                                                      ///< Attribute "identifier" "name"
    std::string asset;  ///< the name of the outermost block that has one
    bool visible_to_camera = true;
    bool cull_hidden = true;  ///< Attribute "cull" "hidden": may stay unshaded where no sample sees it
    RayAttributes rays;
    /// Options of dicing (Attribute "dice").
    struct Dice {
        bool binary = false;          ///< rates are powers of two
        bool raster_oriented = true;  ///< rates by the size on the screen, not by the size alone
        float min_length = 0;         ///< of a curve's micropolygons, pixels
        bool operator==(const Dice&) const = default;
    } dice;
    /// GeometricApproximation: blur by motion or defocus coarsens dicing by this much; 0: never.
    float motion_factor = 0, focus_factor = 0;
    UserValues user;  ///< every Attribute, by category
};

/// Geometry with its attributes and motion.
struct Primitive {
    std::shared_ptr<const Attributes> attributes;
    /// Poses of a deforming shape at its own evenly spaced keys (1 or 2^m + 1 of them), all of one topology
    /// and with the same variables. Shared by object instances.
    ShapeKeys shape_keys;
    SharedPoses camera_from_object;
    SourceLocation location;
    int solid = -1;     ///< index of the leaf in Scene::solids that it bounds; -1: no part of a solid
    int instance = -1;  ///< number of the ObjectInstance that it came with, whose primitives follow each
                        ///< other; -1: with none
    std::shared_ptr<const LightInstance>
        emitter;  ///< the light that it is a part of the shape of; null: none

    /// Number of keys of the moving primitive: that of its shapes or poses, whichever has more.
    int key_count() const { return static_cast<int>(std::max(shape_keys.size(), camera_from_object.size())); }
    const Shape& shape() const { return *shape_keys.front(); }
};

/// A node of constructive solid geometry (RISpec 5.7). Parents come before their children.
struct Solid {
    enum class Operation : uint8_t { Primitive, Union, Intersection, Difference };

    Operation operation = Operation::Primitive;
    int parent = -1;  ///< -1: outermost
    int place = 0;    ///< among the parent's children: a difference subtracts all but the first
};

/// A plane that cuts away the half space in which normal . p < distance; camera space.
struct ClippingPlane {
    V3f normal{0, 0, 1};  ///< at shutter open, as the distance
    float distance = 0;
    struct Key {
        V3f normal;
        float distance = 0;
    };
    /// At kMaxKeyCount even keys of the shutter, linear in between. Empty: the plane stays.
    std::vector<Key> keys{};
};

/// All of a frame that later stages read. Immutable once the RIB border has made it.
struct Scene {
    Options options;
    std::vector<Solid> solids;  ///< of all SolidBegin/SolidEnd blocks
    std::vector<ClippingPlane> clipping_planes;
    std::vector<Primitive> primitives;  ///< in the order of the file
    M44f camera_from_world;             ///< at shutter open
    /// Of a camera that moves in the shutter, at kMaxKeyCount keys: from camera space then to camera space
    /// at shutter open, as what stands still in the world would have it. Empty: the camera stays.
    std::vector<M44f> held_from_camera;
    std::map<std::string, M44f> camera_from_named;  ///< CoordinateSystem, at shutter open
};

/// Whether solids or clipping planes may cut hits of the primitive away, so that what is behind them must be
/// found too.
inline bool may_be_cut(const Scene& scene, const Primitive& primitive) {
    return primitive.solid >= 0 || !scene.clipping_planes.empty();
}

}  // namespace trapeze
