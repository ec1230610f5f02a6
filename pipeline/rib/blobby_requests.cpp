/// RISpec 5.6: Blobby.
#include <cstdint>

#include "pipeline/rib/primitive_variables.h"
#include "pipeline/rib/request_table.h"

namespace trapeze::rib {
namespace {

constexpr int kMostLeaves = 1 << 24;
constexpr int kFirstLeaf = 1000, kFirstOfTwo = 4, kFirstOfOne = 6, kOperators = 8;

/// The floats that a leaf of a kind reads; -1: no such kind.
int floats_of_leaf(int code) {
    constexpr int kFloats[] = {1, 16, 23, 4};  // constant, ellipsoid, segment, repelling plane
    return code >= kFirstLeaf && code < kFirstLeaf + 4 ? kFloats[code - kFirstLeaf] : -1;
}

/// Walks over the program and checks that every index is in range.
class ProgramCheck {
  public:
    explicit ProgramCheck(const Blobby& blobby) : blobby_(blobby) {}

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
        if (leaves_ != blobby_.leaf_count)
            throw RequestError{"the code has " + std::to_string(leaves_) + " leaves, not " +
                                   std::to_string(blobby_.leaf_count),
                               {}};
    }

  private:
    int next() {
        if (at_ >= blobby_.code.size()) throw RequestError{"the code ends within an operation", {}};
        return blobby_.code[at_++];
    }

    void leaf(int code) {
        const int count = floats_of_leaf(code);
        if (count < 0) throw RequestError{"no operation " + std::to_string(code), {}};
        if (code == kFirstLeaf + 3) {
            const int string = next();
            if (string < 0 || static_cast<size_t>(string) >= blobby_.strings.size())
                throw RequestError{"leaf " + std::to_string(leaves_) + " wants string " +
                                       std::to_string(string) + " of " +
                                       std::to_string(blobby_.strings.size()),
                                   {}};
        }
        const int first = next();
        if (first < 0 || static_cast<int64_t>(first) + count > static_cast<int64_t>(blobby_.floats.size()))
            throw RequestError{"leaf " + std::to_string(leaves_) + " wants " + std::to_string(count) +
                                   " floats from " + std::to_string(first) + " on, of " +
                                   std::to_string(blobby_.floats.size()),
                               {}};
        ++leaves_;
    }

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
};

void blobby(Reader& r, ArgumentCursor& c) {
    Blobby blobby;
    blobby.leaf_count = c.integer("the number of leaves", 0, kMostLeaves);
    blobby.code = c.int_array("the code");
    blobby.floats = c.number_array("the floats");
    // The strings may be left out: then a parameter's name follows, which is no array.
    if (c.next_is_array() && (c.next_is_string() || c.peek()->floats.empty()))
        blobby.strings = c.string_array("the strings");
    ProgramCheck(blobby).run();
    const auto leaves = static_cast<uint64_t>(blobby.leaf_count);
    Shape shape{std::move(blobby), {}};
    shape.variables = checked_variables(r, read_variables(r, c, PointForm::None), shape.topology);
    r.add_shape("Blobby", std::move(shape), leaves);
}

constexpr RequestRow kRows[] = {
    {"Blobby", blobby},
};

}  // namespace

std::span<const RequestRow> blobby_requests() {
    return kRows;
}

}  // namespace trapeze::rib
