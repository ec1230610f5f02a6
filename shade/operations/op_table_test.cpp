#include "shade/operations/op_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "shade/rsl/analysis/builtins.h"
#include "shade/vm/executable.h"
#include "shade/vm/kernels/kernel.h"

namespace trapeze::rsl {
namespace {

using op_traits::has;

/// The widths of a row's form, outputs first; empty when a text is among them, for which there are no
/// kernels.
std::vector<int> widths_of(const OpRow& row) {
    static const std::map<char, int> kWidths = {{'f', 1}, {'b', 1}, {'t', 3}, {'m', 16}};
    std::vector<int> widths;
    for (const char letter : row.operands) {
        if (letter == '=' || letter == '.') continue;
        if (letter == 's') return {};
        widths.push_back(kWidths.at(letter));
    }
    return widths;
}

TEST(OpTable, RowsStandWhereTheirOperationsAre) {
    std::set<std::string_view> names;
    for (size_t i = 0; i < op_table().size(); ++i) {
        EXPECT_EQ(static_cast<size_t>(op_table()[i].op), i);
        EXPECT_TRUE(names.insert(op_table()[i].name).second) << op_table()[i].name;
    }
}

TEST(OpTable, FormsAreWellWritten) {
    for (const OpRow& row : op_table()) {
        SCOPED_TRACE(row.name);
        EXPECT_EQ(std::ranges::count(row.operands, '='), 1);
        EXPECT_EQ(row.operands.find_first_not_of("fbtms=."), std::string_view::npos);
        const size_t dot = row.operands.find('.');
        EXPECT_TRUE(dot == std::string_view::npos || dot + 1 == row.operands.size());
    }
}

TEST(OpTable, EveryRowHasWhatDoesIt) {
    for (const OpRow& row : op_table()) {
        SCOPED_TRACE(row.name);
        if (row.kernels != KernelFamily::None) {
            const std::vector<int> widths = widths_of(row);
            ASSERT_FALSE(widths.empty()) << "the form must be one that the kernel serves";
            EXPECT_TRUE(vm::find_kernel(row.op, widths));
        }
        if (row.context != ContextFamily::None) {
            EXPECT_NE(vm::find_context_op(row.op) != nullptr, vm::find_waiting_op(row.op) != nullptr);
        }
        // The machine runs control itself, and code generation leaves the rewritten ones out.
        const bool done_elsewhere = has(row.op, op_traits::kControl | op_traits::kRewritten);
        EXPECT_EQ(done_elsewhere, row.kernels == KernelFamily::None && row.context == ContextFamily::None);
    }
}

TEST(OpTable, TraitsFitTogether) {
    for (const OpRow& row : op_table()) {
        SCOPED_TRACE(row.name);
        const Op op = row.op;
        EXPECT_TRUE(is_control(op) || !(opens_block(op) || divides_block(op) || closes_block(op)));
        EXPECT_LE(opens_block(op) + divides_block(op) + closes_block(op), 1);
        EXPECT_TRUE(opens_block(op) || !opens_loop(op));
        // What a kernel computes follows from its inputs alone.
        const uint32_t asking = op_traits::kNeighbours | op_traits::kEffect | op_traits::kOnce |
                                op_traits::kVaries | op_traits::kAsks;
        EXPECT_TRUE(row.kernels == KernelFamily::None || !has(op, asking));
        EXPECT_TRUE(asks_surroundings(op) || !(reads_neighbours(op) || is_varying_by_itself(op)));
        EXPECT_TRUE(row.operands.front() != '=' || is_control(op) || !is_pure(op)) << "does nothing";
    }
}

TEST(OpTable, BlocksHaveAsManyEndsAsOpenings) {
    const auto count = [](auto&& trait) {
        return std::ranges::count_if(op_table(), [&](const OpRow& row) { return trait(row.op); });
    };
    EXPECT_EQ(count(opens_block), count(closes_block));
}

TEST(OpTable, RewrittenOperationsAreBuiltinFunctions) {
    for (const OpRow& row : op_table()) {
        if (!has(row.op, op_traits::kRewritten)) continue;
        EXPECT_TRUE(std::ranges::any_of(builtins(), [&](const Builtin& b) { return b.op == row.op; }))
            << row.name;
    }
}

TEST(OpTable, NoBuiltinFunctionIsControl) {
    for (const Builtin& builtin : builtins()) EXPECT_FALSE(is_control(builtin.op)) << builtin.name;
}

}  // namespace
}  // namespace trapeze::rsl
