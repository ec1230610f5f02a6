/// Procedural primitives (RISpec 5.8).
#include <cstdlib>

#include "pipeline/ri/call.h"
#include "pipeline/ri/parameters.h"

namespace trapeze::ri {
namespace {

/// How deep procedurals may be nested. Each is asked for infinite detail, so that one that calls itself would
/// go on for ever.
constexpr int kDeepest = 100;

/// A procedural of RISpec's, which RIB can name; `strings` of its data are its arguments.
struct Known {
    RtProcSubdivFunc function;
    const char* name;
    int strings;
};

constexpr Known kKnown[] = {{RiProcDelayedReadArchive, "DelayedReadArchive", 1},
                            {RiProcRunProgram, "RunProgram", 2},
                            {RiProcDynamicLoad, "DynamicLoad", 2}};

const Known* known(RtProcSubdivFunc function) {
    for (const Known& one : kKnown)
        if (one.function == function) return &one;
    return nullptr;
}

void write_procedural(Context& context, const Known& procedural, RtPointer data, const RtFloat* bound) {
    const auto* const strings = static_cast<const RtString*>(required(data, "the data"));
    const std::vector<std::string> arguments = strings_of(strings, procedural.strings, "the data");
    required(bound, "the bound");
    if (procedural.function == RiProcRunProgram) context.may_run_programs = true;
    context.writer().request("Procedural");
    context.writer().string(procedural.name);
    context.writer().strings(arguments);
    context.writer().numbers({bound, 6});
}

/// Runs a procedural of the program's own: calls its function at once, with infinite detail, within an
/// AttributeBegin and End. The function calls back into the interface.
void run(RtPointer data, RtProcSubdivFunc function) {
    thread_local int depth = 0;
    if (depth >= kDeepest)
        return report(
            {RIE_LIMIT, RIE_ERROR,
             "RiProcedural: more than " + std::to_string(kDeepest) + " within each other; left out"});
    ++depth;
    RiAttributeBegin();
    function(data, RI_INFINITY);
    RiAttributeEnd();
    --depth;
}

}  // namespace
}  // namespace trapeze::ri

using namespace trapeze::ri;

RtVoid RiProcedural(RtPointer data, RtBound bound, RtProcSubdivFunc subdivfunc, RtProcFreeFunc freefunc) {
    bool is_to_run = false;
    call("RiProcedural", [&](Context& context) {
        required(reinterpret_cast<const void*>(subdivfunc), "the function");
        if (const Known* const procedural = known(subdivfunc))
            write_procedural(context, *procedural, data, bound);
        else
            is_to_run = true;
    });
    if (is_to_run) run(data, subdivfunc);
    if (freefunc) freefunc(data);
}

RtVoid RiProcDelayedReadArchive(RtPointer data, RtFloat) {
    RtBound everything = {-RI_INFINITY, RI_INFINITY, -RI_INFINITY, RI_INFINITY, -RI_INFINITY, RI_INFINITY};
    RiProcedural(data, everything, RiProcDelayedReadArchive, nullptr);
}

RtVoid RiProcRunProgram(RtPointer data, RtFloat) {
    RtBound everything = {-RI_INFINITY, RI_INFINITY, -RI_INFINITY, RI_INFINITY, -RI_INFINITY, RI_INFINITY};
    RiProcedural(data, everything, RiProcRunProgram, nullptr);
}

RtVoid RiProcDynamicLoad(RtPointer data, RtFloat) {
    RtBound everything = {-RI_INFINITY, RI_INFINITY, -RI_INFINITY, RI_INFINITY, -RI_INFINITY, RI_INFINITY};
    RiProcedural(data, everything, RiProcDynamicLoad, nullptr);
}

RtVoid RiProcFree(RtPointer data) {
    std::free(data);
}
