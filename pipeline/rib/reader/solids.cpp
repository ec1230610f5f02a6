/// Constructive solid geometry (RISpec 5.7): the tree of solids that surfaces bound.
#include "pipeline/rib/reader/scene_builder.h"

namespace trapeze::rib {
namespace {

constexpr size_t kMostSolids = 1'000'000;  ///< of a scene, or of an object

}  // namespace

/// A solid remembers which child of its parent it is: the order counts for differences.
int SolidList::add(Solid::Operation operation, int parent) {
    if (solids.size() >= kMostSolids)
        throw RequestError{"more than " + std::to_string(kMostSolids) + " solids", {}};
    Solid solid;
    solid.operation = operation, solid.parent = parent;
    if (parent >= 0) solid.place = children[static_cast<size_t>(parent)]++;
    solids.push_back(solid);
    children.push_back(0);
    return static_cast<int>(solids.size()) - 1;
}

/// A primitive solid is bounded by surfaces, and holds no further solids.
void SceneBuilder::begin_solid(Solid::Operation operation) {
    SolidList& list = solids_here();
    if (list.open >= 0 &&
        list.solids[static_cast<size_t>(list.open)].operation == Solid::Operation::Primitive)
        throw RequestError{"inside a primitive solid", {}};
    state_.open(BlockKind::Solid, report_.at());
    list.open = list.add(operation, list.open);
}

/// An end that reached here without a solid open was reported by BlockEnds.
void SceneBuilder::end_solid() {
    SolidList& list = solids_here();
    if (list.open >= 0) list.open = list.solids[static_cast<size_t>(list.open)].parent;
}

/// The solid that a surface bounds. Geometry stands in primitive solids; elsewhere in a solid each surface is
/// taken to be one.
int SceneBuilder::solid_of_surface(SolidList& list) {
    if (list.open < 0) return -1;
    if (list.solids[static_cast<size_t>(list.open)].operation == Solid::Operation::Primitive)
        return list.open;
    report_.warn_once(
        "geometry in a solid stands between SolidBegin \"primitive\" and SolidEnd; each surface outside "
        "of these is taken to be a solid of its own",
        "solid-without-primitive");
    return list.add(Solid::Operation::Primitive, list.open);
}

/// Copies an object's solids into the open one, here; returns where they begin.
int SceneBuilder::place_solids(const SolidList& object) {
    SolidList& list = solids_here();
    const int first = static_cast<int>(list.solids.size());
    for (const Solid& solid : object.solids)
        // Parents come before their children in a list, so one pass with a shift keeps the tree.
        list.add(solid.operation, solid.parent >= 0 ? solid.parent + first : list.open);
    return first;
}

}  // namespace trapeze::rib
