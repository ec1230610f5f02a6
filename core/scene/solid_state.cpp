#include "core/scene/solid_state.h"

namespace trapeze {

SolidState::SolidState(const std::vector<Solid>& solids)
    : solids_(solids),
      child_count_(solids.size()),
      holding_(solids.size()),
      first_holds_(solids.size()),
      inside_(solids.size()) {
    for (const Solid& solid : solids)
        if (solid.parent >= 0) ++child_count_[static_cast<size_t>(solid.parent)];
}

void SolidState::reset() {
    for (const int solid : touched_) {
        const auto s = static_cast<size_t>(solid);
        holding_[s] = 0, first_holds_[s] = false, inside_[s] = false;
    }
    touched_.clear();
}

bool SolidState::holds(int solid) const {
    const auto s = static_cast<size_t>(solid);
    switch (solids_[s].operation) {
        case Solid::Operation::Union:
            return holding_[s] > 0;
        case Solid::Operation::Intersection:
            return holding_[s] == child_count_[s];
        case Solid::Operation::Difference:
            return first_holds_[s] && holding_[s] == 1;
        case Solid::Operation::Primitive:
            break;
    }
    return inside_[s];
}

bool SolidState::whole_holds(int leaf) const {
    int root = leaf;
    while (solids_[static_cast<size_t>(root)].parent >= 0) root = solids_[static_cast<size_t>(root)].parent;
    return inside_[static_cast<size_t>(root)];
}

/// Flips whether the ray is inside a leaf, and tells its parents as long as that changes them. True when the
/// root changes: the surface then borders the whole solid.
bool SolidState::cross(int leaf) {
    int solid = leaf;
    touched_.push_back(solid);
    inside_[static_cast<size_t>(solid)] = !inside_[static_cast<size_t>(solid)];
    while (solids_[static_cast<size_t>(solid)].parent >= 0) {
        const Solid& child = solids_[static_cast<size_t>(solid)];
        const bool child_inside = inside_[static_cast<size_t>(solid)];
        solid = child.parent;
        const auto s = static_cast<size_t>(solid);
        touched_.push_back(solid);
        holding_[s] += child_inside ? 1 : -1;
        if (child.place == 0) first_holds_[s] = child_inside;
        const bool now = holds(solid);
        if (now == inside_[s]) return false;
        inside_[s] = now;
    }
    return true;
}

/// A mirrored space turns what dPdu x dPdv points to over, but not what is outside.
bool sees_border(const Primitive& primitive, bool enters) {
    if (primitive.attributes->sides != 1) return true;
    const bool mirrored = M44d(primitive.camera_from_object.front()).determinant() < 0;
    return enters == (primitive.attributes->reverse_orientation == mirrored);
}

}  // namespace trapeze
