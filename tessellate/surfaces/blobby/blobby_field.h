/// The field of a Blobby (RISpec 5.6): leaves are bumps (1 - r^2)^3 that end at r = 1, constants and
/// repelling planes; operators combine them. What is above kThreshold is inside.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/math.h"
#include "core/scene/shapes.h"
#include "tessellate/surfaces/blobby/repelling_ground.h"

namespace trapeze {

/// A single ellipsoid is drawn at half its extent: (1 - 1/4)^3.
inline constexpr float kBlobbyThreshold = 27.0f / 64;

/// A leaf of a Blobby: a bump round a segment of some space (a capsule there), or round the origin (an
/// ellipsoid). begin, end and radius are in the leaf's space. Its value is (1 - r^2)^3, r the distance from
/// the segment over the radius.
struct BlobbyLeaf {
    bool ends = true;    ///< false: it is everywhere `constant`, or goes by the height above the ground
    float constant = 0;  ///< 0 for a repelling plane whose ground is not known
    std::shared_ptr<RepellingGround> ground;
    M44f object_from_leaf, leaf_from_object;
    V3f begin{0, 0, 0}, end{0, 0, 0};
    float radius = 1;

    /// The leaf's own value and gradient at a point of object space.
    FieldValue at(const V3f& p) const;
    /// Object-space box beyond which it is 0; empty for one that is 0 everywhere, and for what does not end.
    Box3f support() const;
    /// Where a point goes when this leaf becomes another of its kind.
    V3f carried(const V3f& p, const BlobbyLeaf& other) const;
};

/// Operations in the order of the request; results are numbered as they come.
struct BlobbyInstruction {
    /// Same: its operand as it is. Add to Minimum take any number of operands, Subtract and Divide two.
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

/// What a request computes, as a list in which every instruction reads results of earlier ones.
struct BlobbyProgram {
    std::vector<BlobbyInstruction> instructions;
    std::vector<int> operands;

    /// The last instruction's result at a point of object space. `results` is working memory, one for each
    /// thread.
    FieldValue at(const V3f& p, std::span<const BlobbyLeaf> leaves, std::vector<FieldValue>& results) const;
    /// The program with the leaves that are not listed (ascending) at 0, without what has become constant.
    BlobbyProgram reduced(std::span<const int> leaves) const;
};

/// A whole Blobby at one shape key.
struct BlobbyField {
    std::vector<BlobbyLeaf> leaves;  ///< in the order of the per-leaf variables
    BlobbyProgram program;

    /// Repelling planes with a ground, ascending. They act where a bump reaches and nowhere else, so that the
    /// surface ends.
    std::vector<int> grounds;
};

/// Finds the ground by the name of a depth file; gives an empty function when there is none.
using FindGround = std::function<GroundHeight(const std::string& name)>;

/// Reads a request's code, whose counts and references were checked when the RIB file was read.
BlobbyField blobby_field(const Blobby& blobby, const FindGround& find_ground = {});

}  // namespace trapeze
