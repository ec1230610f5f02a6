/// RISpec 5.6: Blobby.
#include <cstdint>

#include "pipeline/rib/requests/primitive_variables.h"
#include "pipeline/rib/requests/request_table.h"

namespace trapeze::rib {
namespace {

/// RISpec 5.6: operations 0 to 7, leaves from 1000 on.
constexpr int kMostLeaves = 1 << 24;
constexpr int kFirstOfTwo = 4, kFirstOfOne = 6, kOperators = 8;
constexpr int kFirstLeaf = 1000, kRepellingPlane = 1003, kImplicitField = 1004;

/// The floats that a leaf of a kind reads; -1: no such kind. An ellipsoid is a matrix; a segment two points,
/// a radius and a matrix; a plane the four numbers of its bulge.
int floats_of_leaf(int code) {
    constexpr int kFloats[] = {1, 16, 23, 4};  // constant, ellipsoid, segment, repelling plane
    return code >= kFirstLeaf && code <= kRepellingPlane ? kFloats[code - kFirstLeaf] : -1;
}

/// Walks over the program and checks that every index is in range, so that later stages, which run it at each
/// point of a field, need not. Operands name earlier results only: a program cannot loop.
class ProgramCheck {
  public:
    explicit ProgramCheck(const Blobby& blobby) : blobby_(blobby) {}

    /// PRMan's fields of compiled code (1004), which are 0 here.
    bool has_implicit_fields() const { return has_implicit_fields_; }

    void run() {
        while (at_ < blobby_.code.size()) {
            const int code = blobby_.code[at_++];
            if (code >= kFirstLeaf)
                leaf(code);
            else if (code >= 0 && code < kOperators)
                operation(code);
            else
                throw RequestError{"no operation " + std::to_string(code), {}};
            ++results_;
        }
        if (results_ == 0) throw RequestError{"the code is empty", {}};
    }

    int leaves() const { return leaves_; }

  private:
    /// The next number of the code.
    int next() {
        if (at_ >= blobby_.code.size()) throw RequestError{"the code ends within an operation", {}};
        return blobby_.code[at_++];
    }

    /// Leaves take one index of floats; repelling planes take the name of a depth map first.
    void leaf(int code) {
        if (code == kImplicitField) {
            has_string(next());
            const int floats = next();
            has_floats(floats, next());
            const int strings = next(), first = next();
            if (strings > 0) has_string(first), has_string(static_cast<int64_t>(first) + strings - 1);
            has_implicit_fields_ = true;
        } else {
            const int count = floats_of_leaf(code);
            if (count < 0) throw RequestError{"no operation " + std::to_string(code), {}};
            if (code == kRepellingPlane) has_string(next());
            has_floats(count, next());
        }
        ++leaves_;
    }

    // 64 bits, as a first index and a count of the file's may overflow 32 when they are added.
    void has_string(int64_t string) const {
        if (string < 0 || string >= static_cast<int64_t>(blobby_.strings.size()))
            throw RequestError{"leaf " + std::to_string(leaves_) + " wants string " + std::to_string(string) +
                                   " of " + std::to_string(blobby_.strings.size()),
                               {}};
    }

    void has_floats(int count, int first) const {
        if (count <= 0) return;
        if (first < 0 || static_cast<int64_t>(first) + count > static_cast<int64_t>(blobby_.floats.size()))
            throw RequestError{"leaf " + std::to_string(leaves_) + " wants " + std::to_string(count) +
                                   " floats from " + std::to_string(first) + " on, of " +
                                   std::to_string(blobby_.floats.size()),
                               {}};
    }

    /// Add, multiply, maximum and minimum say how many operands follow; subtract and divide have two, negate
    /// and identity one. Operands are results of earlier operations and leaves.
    void operation(int code) {
        const int count = code < kFirstOfTwo ? next() : code < kFirstOfOne ? 2 : 1;
        if (count < 1) throw RequestError{"an operation of " + std::to_string(count) + " operands", {}};
        for (int i = 0; i < count; ++i)
            if (const int operand = next(); operand < 0 || operand >= results_)
                throw RequestError{"operand " + std::to_string(operand) + " is not among the " +
                                       std::to_string(results_) + " results before it",
                                   {}};
    }

    const Blobby& blobby_;
    size_t at_ = 0;
    int leaves_ = 0, results_ = 0;
    bool has_implicit_fields_ = false;
};

/// Blobby nleaf [code] [floats] [strings] parameters: a program of operations on leaves; the surface of its
/// last result is drawn.
void blobby(GeometryContext& r, ArgumentCursor& c) {
    Blobby blobby;
    blobby.leaf_count = c.integer("the number of leaves", 0, kMostLeaves);
    blobby.code = c.int_array("the code");
    blobby.floats = c.number_array("the floats");
    // The strings may be left out: then a parameter's name follows, which is no array.
    if (c.next_is_array() && (c.next_is_string() || c.peek()->floats.empty()))
        blobby.strings = c.string_array("the strings");
    ProgramCheck check(blobby);
    check.run();
    if (check.leaves() != blobby.leaf_count) {
        // An example that Pixar published has a wrong count, too: the code is what counts.
        r.report.warn_once("the code has " + std::to_string(check.leaves()) + " leaves, not " +
                               std::to_string(blobby.leaf_count) + "; the code is right",
                           "blobby-leaves");
        blobby.leaf_count = check.leaves();
    }
    if (check.has_implicit_fields())
        r.report.warn_once("fields of compiled code (1004) are not supported; they are 0",
                           "blobby-implicit-field");
    const auto leaves = static_cast<uint64_t>(blobby.leaf_count);
    Shape shape{std::move(blobby), {}};
    shape.variables = checked_variables(r.report, read_variables(r, c, PointForm::None), shape.topology);
    r.add_shape("Blobby", std::move(shape), leaves);
}

constexpr RequestRow kBlobbyRequests[] = {
    {"Blobby", blobby},
};

}  // namespace

std::span<const RequestRow> blobby_requests() {
    return kBlobbyRequests;
}

}  // namespace trapeze::rib
