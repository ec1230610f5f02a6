/// The requests that are known by name, and what carries each of them out. The rows stand in
/// requests/*_requests.cpp, the table that is made of them in requests/request_table.cpp.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace trapeze::rib {

class ArgumentCursor;
class GeometryContext;
class LightContext;
class MapContext;
class RequestContext;
struct ConditionalContext;
struct OptionContext;
struct ProceduralContext;
struct StateContext;
struct StructureContext;
struct TransformContext;

/// What a motion block does with requests (RISpec 6): transforms and geometry have a motion of their own;
/// options and attributes have their values as the shutter opens; structure is not held back.
enum class RequestGroup { Structure, Option, Attribute, Transform, Geometry, Unsupported };

/// Takes the arguments of one request and does what it says. Throws a RequestError where the request has to
/// be skipped; an argument that it leaves is reported by its caller.
template <class Context>
using HandlerWith = void (*)(Context& context, ArgumentCursor& cursor);

/// A handler with the context of its family (request_context.h), of which it has what its requests need.
/// std::monostate: none.
using RequestHandler =
    std::variant<std::monostate, HandlerWith<RequestContext>, HandlerWith<StateContext>,
                 HandlerWith<OptionContext>, HandlerWith<TransformContext>, HandlerWith<LightContext>,
                 HandlerWith<GeometryContext>, HandlerWith<MapContext>, HandlerWith<StructureContext>,
                 HandlerWith<ConditionalContext>, HandlerWith<ProceduralContext>>;

/// A row of the table, made once and never changed: pointers to it are valid until the program ends.
struct Request {
    RequestHandler handler;
    RequestGroup group = RequestGroup::Unsupported;  ///< then it is known, and has no handler
    std::string name;                                ///< as RIB writes it
    size_t number = 0;                               ///< its place among request_names()
};

/// Null for unknown names.
const Request* find_request(std::string_view name);

/// Asked by the parser of words within brackets: a known name there means that the bracket was never closed.
/// Outside of brackets any word ends the request before it, since RIB has no other mark for that.
bool is_request(std::string_view name);
/// All known ones, sorted.
std::vector<std::string> request_names();
/// The known request most like a misspelt name, or nothing. Used in messages alone; nothing is carried out
/// under a guessed name.
std::string suggestion_for(const std::string& name);

}  // namespace trapeze::rib
