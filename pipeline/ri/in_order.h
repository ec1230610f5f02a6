/// Calls whose arguments are those of their request, in the same order: maps, quadrics, shaders. Their V
/// forms are made from rows of the tables in ri.h.
#pragma once

#include <string>

#include "pipeline/ri/call.h"
#include "pipeline/ri/names.h"
#include "pipeline/ri/parameters.h"

namespace trapeze::ri {

/// One argument of a call: `check` throws a CallError that calls it `what`, `write` is for those that passed.
struct InOrder {
    static void check(RtFloat, const char*) {}
    static void check(RtString text, const char* what) { required(text, what); }
    static void check(const RtFloat* point, const char* what) { required(point, what); }
    static void check(RtFilterFunc filter, const char*) { filter_name(filter); }

    static void write(rib::RibWriter& writer, RtFloat number) { writer.number(number); }
    static void write(rib::RibWriter& writer, RtString text) { writer.string(text); }
    static void write(rib::RibWriter& writer, RtFilterFunc filter) { writer.string(filter_name(filter)); }
    /// An RtPoint.
    static void write(rib::RibWriter& writer, const RtFloat* point) {
        for (int i = 0; i < 3; ++i) writer.number(point[i]);
    }
};

/// What write_in_order() needs beside the arguments themselves.
struct OrderedCall {
    const char* request;
    const char* what;  ///< what an argument is called that is null
    RiArguments parameters;
    VariableCounts counts{};    ///< of the primitive, for the parameters' lengths
    std::string category = {};  ///< as checked_parameters() takes it
};

/// Writes a request, all or nothing: what is wrong is thrown before its first word.
template <class... Arguments>
void write_in_order(Context& context, const OrderedCall& one, Arguments... arguments) {
    (InOrder::check(arguments, one.what), ...);
    const auto parameters = checked_parameters(context, one.parameters, one.counts, one.category);
    context.writer().request(one.request);
    (InOrder::write(context.writer(), arguments), ...);
    write_parameters(context.writer(), parameters);
}

/// Defines the V form of a row. `ordered(context, request, parameters)` makes its OrderedCall.
#define RI_DEFINE_IN_ORDER(ordered, Name, parameters, names)                                            \
    RtVoid Ri##Name##V(RI_WITHOUT_BRACKETS parameters, RtInt n, RtToken tokens[], RtPointer values[]) { \
        call("Ri" #Name, [&](Context& context) {                                                        \
            write_in_order(context, ordered(context, #Name, {n, tokens, values}),                       \
                           RI_WITHOUT_BRACKETS names);                                                  \
        });                                                                                             \
    }

}  // namespace trapeze::ri
