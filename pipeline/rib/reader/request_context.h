/// What the handler of a request works with.
#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "pipeline/rib/reader/request_report.h"
#include "pipeline/rib/state/graphics_state_stack.h"
#include "pipeline/rib/syntax/arguments.h"

namespace trapeze::rib {

class BlockEnds;
class ConditionalBlocks;
class FileSearch;
class MotionCollector;
class OpenFiles;
class Procedurals;
class RequestStream;
class SceneBuilder;

/// What becomes of parameters that nobody declared: primitives leave them out, options and attributes keep
/// them as what they look like; so do shaders, which know better what they are and say what they do not have.
enum class Undeclared { LeaveOut, Guess };

/// The owners of what requests read and change, each with its own header: a file of handlers includes those
/// that its requests touch. Helpers of handlers take the one or two owners that they need, not this.
struct RequestContext {
    RequestReport& report;          ///< messages and counts
    GraphicsStateStack& state;      ///< attributes, options, transformation, blocks
    MotionCollector& motion;        ///< the open motion block; all transformations
    SceneBuilder& scene;            ///< worlds, geometry, lights, objects, solids
    BlockEnds& blocks;              ///< AttributeEnd and the like
    ConditionalBlocks& conditions;  ///< IfBegin and the like
    OpenFiles& files;
    FileSearch& search;
    RequestStream& stream;  ///< archives
    Procedurals& procedurals;

    /// Name and value pairs to the end of the request, colours as RGB; wrong ones are reported and left out.
    /// Whether they fit to a primitive is not looked at (checked_variables).
    ParameterList parameters(ArgumentCursor& cursor, Undeclared undeclared = Undeclared::LeaveOut);
    /// A shader's parameter list: each parameter has one value (which may be an array).
    ParameterList shader_parameters(ArgumentCursor& cursor);
    /// The name of a shader, placed in the current space; its other arguments are still to come. `kind` is
    /// what the summary counts it as.
    ShaderInstance shader(ArgumentCursor& cursor, const char* kind);
};

}  // namespace trapeze::rib
