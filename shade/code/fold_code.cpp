#include <cstring>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "shade/code/blocks.h"
#include "shade/code/optimise.h"
#include "shade/operations/op_table.h"
#include "shade/vm/kernels/kernel.h"

namespace trapeze::rsl {
namespace {

/// Runs one operation on constants, by the kernel that would run it on grids. Using the kernel itself makes
/// folding exact on every machine: a value folded at compile time has the bits that the run would have made.
class ConstantMachine {
  public:
    /// The values of the output; nothing when the operation has no kernel.
    static std::optional<std::vector<float>> run(const Program& program, const Instruction& instruction) {
        std::vector<int> widths;
        for (const RegisterId id : instruction.operands) {
            const Type type = program.reg(id).type;
            if (type.is_array() || width_of(type.base) == 0) return {};
            widths.push_back(width_of(type.base));
        }
        const vm::Kernel kernel = vm::find_kernel(instruction.op, widths);
        if (!kernel) return {};
        constexpr size_t kMaxOperands = 20;
        if (widths.size() > kMaxOperands) return {};
        alignas(64) float memory[kMaxOperands][16][kLanes];
        std::vector<vm::Operand> operands(widths.size());
        for (size_t k = 0; k < widths.size(); ++k) {
            operands[k].data = memory[k][0];
            operands[k].stride = widths[k] > 1 ? kLanes : 0;
            const Register& r = program.reg(instruction.operands[k]);
            for (int c = 0; c < widths[k]; ++c)
                for (float& lane : memory[k][c])
                    lane = k < instruction.outputs ? 0.0f : r.values[static_cast<size_t>(c)];
        }
        kernel(kLanes, operands);
        std::vector<float> values;
        for (int c = 0; c < widths[0]; ++c) values.push_back(memory[0][c][0]);
        return values;
    }
};

/// Folds constants, follows copies and reuses common subexpressions in one walk over the code, as value
/// numbering does. A value is a register and its version, which counts the writes to it: what was computed
/// from older versions is not found any more. What is known of values is undone at the end of the block in
/// which it was learnt, since another lane (or none) may have gone through it.
class Folder {
  public:
    Folder(Program& program, Code& code) : program_(program), code_(code), blocks_(code) {}

    void run() {
        Code folded;
        folded.reserve(code_.size());
        for (size_t i = 0; i < code_.size(); ++i) {
            if (i < skip_until_) continue;
            visit(i, folded);
        }
        code_ = std::move(folded);
    }

  private:
    /// An operation with its inputs as they were: equal keys give equal results.
    using Key = std::tuple<Op, int32_t, Base, std::vector<std::pair<RegisterId, uint32_t>>>;
    /// A register that holds the same value, as long as neither is set again.
    struct Copy {
        RegisterId of;
        uint32_t version, of_version;
    };
    /// What was learnt in a block, to be forgotten at its end.
    struct Undo {
        std::vector<Key> keys;
        std::vector<std::pair<RegisterId, std::optional<Copy>>> copies;
        RegisterId condition = 0;  ///< of an If, as it was folded
        bool removed = false;      ///< the block's markers are left out
    };

    /// How often a register has been written on the way here; constants are made as the walk goes.
    uint32_t version(RegisterId id) {
        if (id >= versions_.size()) versions_.resize(program_.registers.size() + 64, 0);
        return versions_[id];
    }
    void set_again(RegisterId id) {
        version(id);
        ++versions_[id];
    }

    /// The register that a copy was made from, where both still hold the same value; else the register
    /// itself.
    RegisterId newest(RegisterId id) {
        const auto known = copies_.find(id);
        if (known == copies_.end()) return id;
        const Copy& copy = known->second;
        return copy.version == version(id) && copy.of_version == version(copy.of) ? copy.of : id;
    }

    /// What was known before is kept for the end of the block, where it holds again.
    void learn_copy(RegisterId id, RegisterId of) {
        const auto known = copies_.find(id);
        if (!undo_.empty())
            undo_.back().copies.push_back(
                {id, known == copies_.end() ? std::nullopt : std::optional(known->second)});
        copies_[id] = {of, version(id), version(of)};
    }

    /// Copies are put back in reverse, so that the oldest of several has the last word.
    void forget(const Undo& undo) {
        for (const Key& key : undo.keys) known_.erase(key);
        for (size_t i = undo.copies.size(); i-- > 0;) {
            const auto& [id, before] = undo.copies[i];
            if (before)
                copies_[id] = *before;
            else
                copies_.erase(id);
        }
    }

    /// Whatever the code from `first` to `last` writes may hold a new value: the loop may come round, the
    /// branch be taken.
    void set_all_written(size_t first, size_t last) {
        std::vector<RegisterId> written;
        collect_written(code_, first, last, written);
        for (const RegisterId id : written) set_again(id);
    }

    /// One instruction: a block's mark, or any other.
    void visit(size_t i, Code& folded) {
        Instruction instruction = code_[i];
        if (opens_block(instruction.op))
            open(i, instruction, folded);
        else if (blocks_.opening[i] != Blocks::kNone)
            divide_or_close(i, instruction, folded);
        else
            plain(instruction, folded);
    }

    /// Inputs that are copies become what they are copies of, so that the Move itself may be pruned.
    void follow_copies(Instruction& instruction) {
        for (size_t k = instruction.outputs; k < instruction.operands.size(); ++k)
            instruction.operands[k] = newest(instruction.operands[k]);
    }

    /// The beginning of a block. An If whose condition is a constant is left out, and so is the half that is
    /// never taken: the walk goes on behind it.
    void open(size_t i, Instruction& instruction, Code& folded) {
        const bool repeats = opens_loop(instruction.op);
        // A loop over lights asks for its inputs in each turn: they must be what no turn sets.
        if (repeats) set_all_written(i, blocks_.end[i]);
        follow_copies(instruction);
        for (size_t k = 0; k < instruction.outputs; ++k) set_again(instruction.operands[k]);
        undo_.emplace_back();
        if (instruction.op == Op::If) {
            undo_.back().condition = instruction.input(0);
            if (const auto decided = constant_bool(instruction.input(0))) {
                undo_.back().removed = true;
                const size_t middle = blocks_.middle[i];
                if (!*decided) skip_until_ = middle != Blocks::kNone ? middle : blocks_.end[i];
                return;
            }
        }
        folded.push_back(std::move(instruction));
    }

    /// The middle or the end of a block. What its first half taught is forgotten before the second begins,
    /// and all that it wrote counts as written.
    void divide_or_close(size_t i, Instruction& instruction, Code& folded) {
        Undo& undo = undo_.back();
        const size_t opening = blocks_.opening[i];
        const bool removed = undo.removed;
        if (closes_block(instruction.op)) {
            // A half that is always taken leaves what was learnt in it.
            if (!removed) {
                forget(undo);
                set_all_written(opening + 1, i);
                undo_.pop_back();
                folded.push_back(std::move(instruction));
                return;
            }
            Undo inner = std::move(undo);
            undo_.pop_back();
            if (undo_.empty()) return;
            Undo& outer = undo_.back();
            outer.keys.insert(outer.keys.end(), inner.keys.begin(), inner.keys.end());
            outer.copies.insert(outer.copies.end(), inner.copies.begin(), inner.copies.end());
            return;
        }
        if (instruction.op == Op::Else) {
            if (removed) {
                // Reached from the taken first half, or jumped to because the second is taken.
                if (skip_until_ != i) skip_until_ = blocks_.end[i];
                return;
            }
            instruction.operands = {undo.condition};
        }
        forget(undo);
        undo.keys.clear();
        undo.copies.clear();
        set_all_written(opening + 1, i);
        folded.push_back(std::move(instruction));
    }

    /// The value of a constant Bool, all bits or none.
    std::optional<bool> constant_bool(RegisterId id) const {
        const Register& r = program_.reg(id);
        if (r.kind != Register::Kind::Constant || r.type.base != Base::Bool) return {};
        uint32_t bits = 0;
        std::memcpy(&bits, r.values.data(), sizeof bits);
        return bits != 0;
    }

    /// Random() has no inputs, and is not constant for that.
    bool all_constant(const Instruction& instruction) const {
        for (size_t k = 0; k < instruction.input_count(); ++k)
            if (program_.reg(instruction.input(k)).kind != Register::Kind::Constant) return false;
        return instruction.input_count() > 0;
    }

    /// A new register each time: equal constants that folding makes are not shared.
    RegisterId add_constant(Type type, std::vector<float> values) {
        Register r;
        r.kind = Register::Kind::Constant;
        r.type = type;
        r.values = std::move(values);
        program_.registers.push_back(std::move(r));
        return static_cast<RegisterId>(program_.registers.size() - 1);
    }

    /// An instruction that is no mark of a block; one that may not be folded still counts as a write.
    void plain(Instruction& instruction, Code& folded) {
        follow_copies(instruction);
        const bool single = instruction.outputs == 1;
        if (single && is_repeatable(instruction.op) && !is_control(instruction.op) &&
            !program_.reg(instruction.output()).type.is_array())
            fold_or_reuse(instruction);
        else
            for (size_t k = 0; k < instruction.outputs; ++k) set_again(instruction.operands[k]);
        folded.push_back(std::move(instruction));
    }

    /// An operation with one output that may be done once for two. All inputs constant: it becomes a Move of
    /// the constant that the machine's own kernel gives, so that folding changes no bit. Done before with the
    /// same inputs: a Move of that result. Constants of equal width are not folded through Move, which
    /// follow_copies() sees through anyway.
    void fold_or_reuse(Instruction& instruction) {
        const RegisterId out = instruction.output();
        const Type type = program_.reg(out).type;
        if (instruction.op != Op::Move && all_constant(instruction)) {
            if (auto values = ConstantMachine::run(program_, instruction))
                make_move(instruction, add_constant(type, std::move(*values)));
        } else if (instruction.op == Op::Move && all_constant(instruction) && type.base != Base::String &&
                   width_of(program_.reg(instruction.input(0)).type.base) != width_of(type.base)) {
            if (auto values = ConstantMachine::run(program_, instruction))
                make_move(instruction, add_constant(type, std::move(*values)));
        }
        if (instruction.op == Op::Move) {
            const RegisterId from = instruction.input(0);
            set_again(out);
            const Type source = program_.reg(from).type;
            if (!source.is_array() && source.base != Base::String && type.base != Base::String &&
                width_of(source.base) == width_of(type.base) && from != out)
                learn_copy(out, from);
            else if (source.base == Base::String && program_.reg(from).kind == Register::Kind::Constant)
                learn_copy(out, from);
            return;
        }
        Key key{instruction.op, instruction.immediate, type.base, {}};
        for (size_t k = 0; k < instruction.input_count(); ++k) {
            const RegisterId id = instruction.input(k);
            std::get<3>(key).push_back({id, version(id)});
        }
        const auto known = known_.find(key);
        if (known != known_.end() && known->second.second == version(known->second.first)) {
            const RegisterId same = known->second.first;
            make_move(instruction, same);
            set_again(out);
            if (same != out) learn_copy(out, same);
            return;
        }
        bool reads_itself = false;
        for (size_t k = 0; k < instruction.input_count(); ++k)
            reads_itself = reads_itself || instruction.input(k) == out;
        set_again(out);
        if (reads_itself) return;
        known_[key] = {out, version(out)};
        if (!undo_.empty()) undo_.back().keys.push_back(std::move(key));
    }

    /// The source place and the region stay: the instruction still stands where it stood.
    static void make_move(Instruction& instruction, RegisterId from) {
        instruction.op = Op::Move;
        instruction.immediate = 0;
        instruction.operands = {instruction.output(), from};
    }

    Program& program_;
    Code& code_;
    Blocks blocks_;
    size_t skip_until_ = 0;
    std::vector<uint32_t> versions_;
    std::unordered_map<RegisterId, Copy> copies_;
    std::map<Key, std::pair<RegisterId, uint32_t>> known_;
    std::vector<Undo> undo_;
};

}  // namespace

void fold_code(Program& program, Code& code) {
    Folder(program, code).run();
}

}  // namespace trapeze::rsl
