/// Constructive solid geometry: SolidBegin, SolidEnd (RISpec 5.7).
#include "pipeline/rib/reader/block_ends.h"
#include "pipeline/rib/reader/scene_builder.h"
#include "pipeline/rib/requests/request_table.h"

namespace trapeze::rib {
namespace {

/// RISpec 5.7; "primitive" is the one that geometry may stand in. Another word leaves the block closed, so
/// that its SolidEnd is an error too.
Solid::Operation operation_of(ArgumentCursor& c) {
    const std::string name = c.string("the operation");
    if (name == "primitive") return Solid::Operation::Primitive;
    if (name == "union") return Solid::Operation::Union;
    if (name == "intersection") return Solid::Operation::Intersection;
    if (name == "difference") return Solid::Operation::Difference;
    throw RequestError{in_quotes(name) + " is none of primitive, union, intersection, difference", {}};
}

/// SolidBegin "operation" and SolidEnd.
constexpr RequestRow kSolidRequests[] = {
    {"SolidBegin", [](StructureContext& r, ArgumentCursor& c) { r.scene.begin_solid(operation_of(c)); }},
    {"SolidEnd", [](StructureContext& r, ArgumentCursor&) { r.blocks.end(BlockKind::Solid); }},
};

}  // namespace

std::span<const RequestRow> solid_requests() {
    return kSolidRequests;
}

}  // namespace trapeze::rib
