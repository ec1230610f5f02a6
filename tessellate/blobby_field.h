/// The field of a Blobby (RISpec 5.6): leaves are bumps (1 - r^2)^3 that end at r = 1, operators combine
/// them. What is above kThreshold is inside.
#pragma once

#include <span>
#include <vector>

#include "core/math.h"
#include "core/shapes.h"

namespace trapeze {

/// A single ellipsoid is drawn at half its extent: (1 - 1/4)^3.
inline constexpr float kBlobbyThreshold = 27.0f / 64;

struct FieldValue {
    float value = 0;
    V3f gradient{0, 0, 0};
};

/// A bump round a segment of some space, or round the origin.
struct BlobbyLeaf {
    bool ends = true;  ///< false: it is everywhere `constant`
    float constant = 0;
    M44f object_from_leaf, leaf_from_object;
    V3f begin{0, 0, 0}, end{0, 0, 0};
    float radius = 1;

    FieldValue at(const V3f& p) const;
    /// Object-space box beyond which it is 0; empty for one that is 0 everywhere.
    Box3f support() const;
    /// Where a point goes when this leaf becomes another of its kind.
    V3f carried(const V3f& p, const BlobbyLeaf& other) const;
};

/// Operations in the order of the request; results are numbered as they come.
struct BlobbyInstruction {
    enum class Kind : uint8_t {
        Leaf,
        Constant,
        Add,
        Multiply,
        Maximum,
        Minimum,
        Subtract,
        Divide,
        Negate,
        Same
    };

    Kind kind = Kind::Constant;
    int leaf = 0;
    float constant = 0;
    int first_operand = 0, operand_count = 0;  ///< in operands
};

struct BlobbyProgram {
    std::vector<BlobbyInstruction> instructions;
    std::vector<int> operands;

    /// The last instruction's result.
    FieldValue at(const V3f& p, std::span<const BlobbyLeaf> leaves, std::vector<FieldValue>& results) const;
    /// The program with the leaves that are not listed (ascending) at 0, without what has become constant.
    BlobbyProgram reduced(std::span<const int> leaves) const;
};

struct BlobbyField {
    std::vector<BlobbyLeaf> leaves;  ///< in the order of the per-leaf variables
    BlobbyProgram program;
    bool has_planes = false;  ///< repelling planes, which are left out
};

BlobbyField blobby_field(const Blobby& blobby);

}  // namespace trapeze
