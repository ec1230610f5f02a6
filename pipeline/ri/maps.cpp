/// Texture, environment and shadow maps (RISpec 7): names, wrap modes, an angle, a filter and its widths.
#include "pipeline/ri/in_order.h"

namespace trapeze::ri {
namespace {

OrderedCall map(Context& context, const char* request, const RiArguments& parameters) {
    context.expect_options();
    return {request, "a name", parameters, {}, "map"};
}

}  // namespace
}  // namespace trapeze::ri

using namespace trapeze::ri;

#define RI_DEFINE_MAP(Type, Name, parameters, names, last) RI_DEFINE_IN_ORDER(map, Name, parameters, names)

RI_MAP_CALLS(RI_DEFINE_MAP)
