/// What a run of a shader may ask of what is around it. The machine calls these with a lane mask where lanes
/// differ; outputs are whole planes, of which lanes that do not run are not read.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/diagnostics.h"
#include "core/math.h"
#include "core/task.h"
#include "shade/planes/planes.h"
#include "shade/rsl/syntax/type.h"
#include "shade/vm/footprint.h"
#include "shade/vm/kernels/grid_span.h"
#include "shade/vm/kernels/kernel.h"

namespace trapeze::vm {

class Registers;
class Run;
struct Step;

/// The vertices of one or more grids of one primitive, side by side in the lanes of a run. Small grids share
/// a batch, since what a run costs besides its arithmetic does not depend on how many lanes it has.
struct Batch {
    size_t vertices = 0;
    size_t lanes = 0;  ///< padded_size(vertices)
    std::vector<GridSpan> spans;
};

/// The coordinate systems that shaders name in transform(), mtransform() and casts of points: the predefined
/// ones, those of CoordinateSystem, and the shader's own. Points of a run are in "current" space, which here
/// is camera space for every kind of shader.
class Spaces {
  public:
    virtual ~Spaces() = default;
    /// Row vectors: p' = p * m. Nothing for a name that is not known.
    virtual std::optional<M44f> matrix(std::string_view from, std::string_view to) const = 0;
};

/// The rays of a gather block, of which each lane has one in each turn. It is made when a block is entered,
/// once for all its lanes, and dropped when the block is left; blocks nest, and each has its own.
class GatherTurns {
  public:
    virtual ~GatherTurns() = default;
    /// Takes the next turn of the lanes whose bits are set in `live`, which only ever lose some, and sets the
    /// outputs in these. False when no lane has a ray left.
    virtual Task<bool> next(Run& run, const uint32_t* live) = 0;
    /// Masks of the lanes whose ray of this turn hits something, and of those where it does not.
    virtual const float* hits() const = 0;
    virtual const float* misses() const = 0;
};

/// Texture, environment and shadow maps, by the names that shaders write. shade/maps implements it over
/// files; the machine hands on whole steps and not single lookups, since what one costs besides its
/// arithmetic (finding the file, reading the named arguments) is paid once for a batch.
class Maps {
  public:
    virtual ~Maps() = default;
    /// One of Op::Texture, Environment, Shadow, Bump or TextureInfo.
    virtual void look_up(Run& run, const Step& step, std::span<const Operand> operands) = 0;
    /// Colours of an environment map in some directions, each averaged over about its width, or over the one
    /// that there is (radians). Black where it cannot be read.
    virtual void sky(std::string_view name, SourceLocation at, std::span<const V3f> directions,
                     std::span<const float> widths, std::span<V3f> colors) = 0;
    /// The turns of Op::Gather in an environment map: parts of it. Null where it cannot be read. The operands
    /// stay as they are until the block is left.
    virtual std::unique_ptr<GatherTurns> gather_sky(std::string_view name, Run& run, const Step& step,
                                                    std::span<const Operand> operands) = 0;
};

/// Point clouds: files of discs that bake3d() writes and texture3d(), occlusion() and indirectdiffuse() read
/// [Christensen08]. shade/clouds implements it.
class Clouds {
  public:
    virtual ~Clouds() = default;
    /// Op::Texture3d.
    virtual void look_up(Run& run, const Step& step, std::span<const Operand> operands) = 0;
    /// Op::Bake3d.
    virtual void bake(Run& run, const Step& step, std::span<const Operand> operands) = 0;
    /// Op::Occlusion or IndirectDiffuse by the discs of a cloud; false where rays are to be sent.
    virtual bool over_discs(Run& run, const Step& step, std::span<const Operand> operands) = 0;
};

/// What an illuminance block gives to lights in place of a parameter's own value ("send:light:NAME").
struct SentValue {
    std::string_view name;               ///< of the parameter
    rsl::Type type;                      ///< not an array that grows
    Operand value;                       ///< not of texts
    std::span<const std::string> texts;  ///< of texts, all elements
};

/// What is asked of a light.
struct LightRequest {
    Operand P;
    bool lasting = false;  ///< P will not change in this run, and what was found for it may be kept
    bool refresh = false;  ///< the light is run, whatever has been kept
    std::span<const SentValue> sent = {};
    const uint32_t* lanes = nullptr;  ///< mask of those that send: others have the light's own values where
                                      ///< what is sent differs from lane to lane
    size_t depth = 0;                 ///< of the illuminance block that asks, in others
    SourceLocation at = {};           ///< of that block
};

/// The lights of a grid, and what they send to points. A light is known by its number, from 0 on; an area
/// light counts as many, each of them at another place of its shape [decision 0030].
class Lights {
  public:
    virtual ~Lights() = default;
    virtual size_t count() const = 0;

    /// One light as the points of a batch see it. The planes belong to whoever implements Lights and hold
    /// until the next call for the same light; what it sends where it is given values holds until the next
    /// call of that depth. Their lanes are those of the run that asked.
    struct Arriving {
        bool ambient = false;
        const float* L = nullptr;              ///< to the light; 3 planes; 0 of ambient ones
        const float* direction = nullptr;      ///< L, of unit length
        const float* Cl = nullptr;             ///< 3 planes; zero where the light does not reach
        const float* lit = nullptr;            ///< lanes that the light's cone holds
        bool distant = false;                  ///< there is no place that L leads to
        float diffuse = 1, specular = 1;       ///< shares in those built-in functions
        uint32_t word = 0;                     ///< of the light and its sample: random numbers follow from it
        const Registers* registers = nullptr;  ///< the light's variables
    };
    /// The request must live until the task is done.
    virtual Task<const Arriving*> arriving(size_t light, const LightRequest& request) = 0;
    /// Whether its categories (output parameter __category) are among those wanted: "a,b", or "-a" for all
    /// others, or "a&-b".
    virtual bool in_category(const Arriving& light, std::string_view wanted) = 0;
    /// Whether illuminance over these categories takes it. Ambient ones have a turn only where they are asked
    /// for.
    virtual bool in_loop(const Arriving& light, std::string_view wanted) {
        return !light.ambient && in_category(light, wanted);
    }
};

/// What raylabel() and rayinfo() tell of the ray that has hit the points which are shaded.
struct RayFacts {
    int depth = 0;  ///< bounces from the camera: 0 for what it sees itself
    int diffuse_depth = 0, specular_depth = 0, shadow_depth = 0;
    std::string_view type = "camera";  ///< or "diffuse", "specular", "transmission"
    std::string_view label;
};

/// Rays through the scene. What their surfaces send back takes runs of other shaders, which is why most of it
/// is a Task.
class Rays {
  public:
    virtual ~Rays() = default;
    /// One of Op::Trace, Transmission, Visibility, Occlusion or IndirectDiffuse; Environment; or Shadow, of
    /// the light whose shader calls it.
    virtual Task<> trace(Run& run, const Step& step, std::span<const Operand> operands) = 0;
    /// The rays of Op::Gather. The operands stay as they are until the block is left.
    virtual std::unique_ptr<GatherTurns> gather(Run& run, const Step& step,
                                                std::span<const Operand> operands) = 0;
    virtual RayFacts facts() const = 0;
};

/// Variables of the other shaders that work on the grid, attributes and options. Its answers are those of
/// RISpec 3.2, section 15.8: a surface may look at its displacement, a light at the surface that it lights.
class Messages {
  public:
    virtual ~Messages() = default;
    /// False when there is no such value of that type; else sets it in all lanes of the output, or the texts:
    /// all elements of an array, or one.
    /// `light`: the variables of the light of the illuminance block which asks; null where there is none.
    virtual bool find(rsl::Op what, std::string_view name, rsl::Type type, const Operand& out,
                      std::span<std::string> texts, const Registers* light) = 0;
    /// Of a kind that is named; a shader knows its own name.
    virtual std::string shader_name(std::string_view kind) = 0;
};

/// What an illuminate or solar block tells about the light, gathered over a run of a light shader. The block
/// runs masked, so lanes outside its cone keep what the caller put there before the run.
struct LightOutput {
    float* L = nullptr;       ///< from the light to the point: 3 planes
    uint32_t* lit = nullptr;  ///< a plane
    bool distant = false;     ///< by a solar block: there is no place that L comes from
    bool is_known = false;    ///< such a block has been entered
};

/// The surroundings of one run. Pointers are borrowed from who starts it and outlive the run; any of them may
/// be null, where shaders of its kind cannot ask (an imager has no lights, a test no scene), and the
/// operation then does what its source file says: nothing is found, nothing is lit.
struct Context {
    const Batch* batch = nullptr;
    const Spaces* spaces = nullptr;
    Footprints* footprints = nullptr;  ///< of the points
    Maps* maps = nullptr;
    Clouds* clouds = nullptr;
    Lights* lights = nullptr;
    Rays* rays = nullptr;
    Messages* messages = nullptr;
    LightOutput* light_output = nullptr;  ///< in lights
    /// In lights that move: when the rays of each lane leave, so that they meet the light where it is
    /// sampled.
    std::span<const float> ray_times = {};
    /// In lights with an area: how far its points may lie from what rays meet of it.
    float light_roughness = 0;
    Diagnostics* diagnostics = nullptr;
    float near_clip = 0, far_clip = 1;          ///< camera-space z
    float shutter_open = 0, shutter_close = 0;  ///< times of the scene
    bool perspective = true;                    ///< the camera's
};

}  // namespace trapeze::vm
