/// Procedural (RISpec 5.8) and PRMan's Procedural2.
#include "pipeline/rib/reader/procedurals.h"
#include "pipeline/rib/requests/request_table.h"

namespace trapeze::rib {
namespace {

/// A known kind that is not supported, or an unknown one.
[[noreturn]] void refuse(const std::string& kind) {
    if (kind == "DynamicLoad" || kind == "DynamicLoad2")
        throw RequestError{
            in_quotes(kind) + " of Procedural2 wants another renderer's interface; not supported", {}};
    throw RequestError{"no procedural " + in_quotes(kind), {}};
}

/// The bound may be left out; a program is told the area 0 then.
void procedural(ProceduralContext& r, ArgumentCursor& c) {
    const std::string kind = c.string("the procedural's name");
    std::vector<std::string> data = c.string_array("the arguments");
    std::vector<float> bound;
    if (c.next_is_number()) bound = c.numbers(6, "the bound");
    if (data.empty()) throw RequestError{"has no arguments", {}};
    data.resize(2);
    if (kind == "DelayedReadArchive")
        r.procedurals.delayed_archive(data[0]);
    else if (kind == "RunProgram")
        r.procedurals.run_program(data[0], data[1], bound);
    else if (kind == "DynamicLoad")
        r.procedurals.load_procedural(data[0], data[1], bound);
    else
        refuse(kind);
}

/// The box of a Procedural2; nothing where there is none.
std::vector<float> box_of(const ParameterList& parameters) {
    const Parameter* const hidden = parameters.find("__bound");
    const Parameter* const bound = hidden ? hidden : parameters.find("bound");
    return bound && bound->floats.size() == 6 ? bound->floats : std::vector<float>();
}

/// Name, how it is bounded, and the rest as parameters. "ProcDynamicLoad" is 3Delight's, of libraries as
/// Procedural has them.
void procedural2(ProceduralContext& r, ArgumentCursor& c) {
    const std::string kind = c.string("the procedural's name");
    c.string("the kind of bound");
    const ParameterList parameters = r.parameters(c, Undeclared::Guess);
    const std::string file = parameters.string_or("filename", "");
    if (kind == "DelayedReadArchive" || kind == "DelayedReadArchive2") {
        if (file.empty()) throw RequestError{"\"filename\" is missing", {}};
        r.procedurals.delayed_archive(file);
    } else if (kind == "RunProgram" || kind == "RunProgram2") {
        if (file.empty()) throw RequestError{"\"filename\" is missing", {}};
        r.procedurals.run_program(file, parameters.string_or("data", ""), box_of(parameters));
    } else if (kind == "ProcDynamicLoad") {
        const std::string library = parameters.string_or("dsoname", "");
        if (library.empty()) throw RequestError{"\"dsoname\" is missing", {}};
        r.procedurals.load_procedural(library, parameters.string_or("data", ""), box_of(parameters));
    } else {
        refuse(kind);
    }
}

/// What they read may be anything, worlds included.
constexpr RequestRow kProceduralRequests[] = {{"Procedural", procedural}, {"Procedural2", procedural2}};

}  // namespace

std::span<const RequestRow> procedural_requests() {
    return kProceduralRequests;
}

}  // namespace trapeze::rib
