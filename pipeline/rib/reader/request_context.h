/// What the handlers of requests work with: each family of requests has a context of its own, which holds
/// what its requests read and change, and nothing else.
#pragma once

#include <string>
#include <tuple>

#include "core/scene/scene.h"
#include "pipeline/rib/reader/known_requests.h"
#include "pipeline/rib/reader/request_report.h"
#include "pipeline/rib/state/graphics_state_stack.h"
#include "pipeline/rib/syntax/arguments.h"

namespace trapeze {
struct MapRequest;
}

namespace trapeze::rib {

class BlockEnds;
class ConditionalBlocks;
class FileSearch;
class MotionCollector;
class OpenFiles;
class Procedurals;
class RequestStream;
class SceneBuilder;
enum class FarShape;

/// What becomes of parameters that nobody declared: primitives leave them out, options and attributes keep
/// them as what they look like; so do shaders, which know better what they are and say what they do not have.
enum class Undeclared { LeaveOut, Guess };

/// What every handler has: messages and counts, and parameter lists, which the current state gives a meaning.
/// Contexts are made once for each reading and hold references alone, so copying one is cheap and shares all
/// state.
class RequestContext {
  public:
    RequestContext(RequestReport& request_report, const GraphicsStateStack& state)
        : report(request_report), declared_(state) {}

    /// Name and value pairs to the end of the request, colours as RGB; wrong ones are reported and left out.
    /// Whether they fit to a primitive is not looked at (checked_variables).
    ParameterList parameters(ArgumentCursor& cursor, Undeclared undeclared = Undeclared::LeaveOut) const;
    /// The same of a shader: each has one value (which may be an array).
    ParameterList shader_parameters(ArgumentCursor& cursor) const;
    /// The name of a shader, placed in the current space; its other arguments are still to come. `kind` is
    /// what the summary counts it as.
    ShaderInstance shader(ArgumentCursor& cursor, const char* kind) const;

    RequestReport& report;

  private:
    const GraphicsStateStack& declared_;
};

/// Attributes, and what else of the graphics state a request changes.
struct StateContext : RequestContext {
    StateContext(RequestReport& request_report, GraphicsStateStack& graphics_state)
        : RequestContext(request_report, graphics_state), state(graphics_state) {}

    GraphicsStateStack& state;
};

/// Options, displays, the camera: whether they may change depends on the file that is read.
struct OptionContext : StateContext {
    const OpenFiles& files;
    FileSearch& search;
};

/// Transformations, which an open motion block collects.
struct TransformContext : StateContext {
    MotionCollector& motion;
};

/// Shaders and lights.
class LightContext : public StateContext {
  public:
    LightContext(const StateContext& context, SceneBuilder& scene) : StateContext(context), scene_(scene) {}

    /// See SceneBuilder.
    void add_light(std::shared_ptr<const LightInstance> light);
    bool add_world_light(std::shared_ptr<const LightInstance> light);
    void add_light_surface(const LightInstance& light);
    std::shared_ptr<const LightInstance> light(const std::string& handle) const;

  private:
    SceneBuilder& scene_;
};

/// Primitives, which change nothing but the scene.
class GeometryContext : public RequestContext {
  public:
    GeometryContext(const StateContext& context, SceneBuilder& scene)
        : RequestContext(context), state(context.state), scene_(scene) {}

    /// See SceneBuilder.
    void add_shape(const std::string& request, Shape&& shape, uint64_t faces);
    void place_far_emitter(FarShape shape, float angle = 0);

    const GraphicsStateStack& state;

  private:
    SceneBuilder& scene_;
};

/// MakeTexture and the like.
class MapContext : public RequestContext {
  public:
    MapContext(const RequestContext& context, SceneBuilder& scene) : RequestContext(context), scene_(scene) {}

    /// See SceneBuilder.
    void make_map(MapRequest request);

  private:
    SceneBuilder& scene_;
};

/// Blocks, archives, objects and solids: the requests that move the reader itself.
struct StructureContext : StateContext {
    MotionCollector& motion;
    SceneBuilder& scene;
    BlockEnds& blocks;
    OpenFiles& files;
    RequestStream& stream;
};

/// IfBegin and the like.
struct ConditionalContext : RequestContext {
    ConditionalBlocks& conditions;
};

/// Procedural and the like.
struct ProceduralContext : RequestContext {
    Procedurals& procedurals;
};

/// The contexts of all families. A handler is given the one that its signature names.
using RequestContexts =
    std::tuple<RequestContext, StateContext, OptionContext, TransformContext, LightContext, GeometryContext,
               MapContext, StructureContext, ConditionalContext, ProceduralContext>;

}  // namespace trapeze::rib
