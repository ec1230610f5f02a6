/// Quadrics (RISpec 5.4): all of their arguments are numbers and points.
#include "pipeline/ri/in_order.h"

namespace trapeze::ri {
namespace {

OrderedCall quadric(Context&, const char* request, const RiArguments& parameters) {
    return {request, "a point", parameters, variable_counts(Quadric{}), {}};
}

}  // namespace
}  // namespace trapeze::ri

using namespace trapeze::ri;

#define RI_DEFINE_QUADRIC(Type, Name, parameters, names, last) \
    RI_DEFINE_IN_ORDER(quadric, Name, parameters, names)

RI_QUADRIC_CALLS(RI_DEFINE_QUADRIC)
