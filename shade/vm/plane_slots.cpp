#include "shade/vm/plane_slots.h"

#include <algorithm>
#include <map>

#include "shade/code/blocks.h"
#include "shade/operations/op_table.h"

namespace trapeze::vm {
namespace {

using rsl::Blocks;
using rsl::Register;

/// The instructions during which a register's value is needed: from the first that names it to the last, both
/// included. A register that no instruction of the code names has first = kNone and gets no planes, unless
/// others read it after the run. Arrays of no length in their type have memory of their own.
struct Lifetime {
    size_t first = Blocks::kNone, last = 0;
    uint32_t id = 0;

    void cover(size_t from, size_t to) {
        first = std::min(first, from);
        last = std::max(last, to);
    }
};

/// A value that is used in a loop but made outside must last to the loop's end; a variable, which may carry a
/// value from one turn to the next, lasts for the whole of each loop in which it occurs.
std::vector<Lifetime> lifetimes(const rsl::Program& program) {
    const rsl::Code& code = program.code;
    const Blocks blocks(code);
    std::vector<Lifetime> lives(program.registers.size());
    for (size_t i = 0; i < code.size(); ++i)
        for (const rsl::RegisterId id : code[i].operands) {
            Lifetime& life = lives[id];
            life.id = id;
            const bool temporary = program.reg(id).kind == Register::Kind::Temporary;
            const size_t made = life.first;
            life.cover(i, i);
            // What opens such a block is asked for again in each turn.
            if (rsl::opens_loop(code[i].op)) life.cover(i, blocks.end[i]);
            for (size_t b = blocks.around[i]; b != Blocks::kNone; b = blocks.around[b]) {
                if (!rsl::opens_loop(code[b].op)) continue;
                if (!temporary) life.cover(b, blocks.end[b]);
                if (temporary && made < b) life.cover(i, blocks.end[b]);
            }
        }
    return lives;
}

/// Registers that the defaults of parameters use, which run before the code and by themselves.
std::vector<bool> used_by_defaults(const rsl::Program& program) {
    std::vector<bool> used(program.registers.size(), false);
    for (const rsl::ProgramParameter& parameter : program.parameters)
        for (const rsl::Instruction& instruction : parameter.initial)
            for (const rsl::RegisterId id : instruction.operands) used[id] = true;
    return used;
}

}  // namespace

/// One plane for each component of each element, or of one where a run alone knows how many there are;
/// width_of() is 0 for texts, which have none.
uint32_t plane_count(const rsl::Type& type) {
    return static_cast<uint32_t>(rsl::width_of(type.base) * std::max(type.length, 1));
}

/// Registers are looked at in the order in which their lifetimes begin, and take planes that an older one of
/// the same size has done with, or new ones: register allocation by linear scan, but without spilling, for
/// there are as many planes as are asked for. Fewer planes are fewer bytes for the processor's caches to
/// hold.
PlaneSlots assign_plane_slots(const rsl::Program& program) {
    PlaneSlots slots;
    slots.first.assign(program.registers.size(), 0);
    std::vector<Lifetime> lives = lifetimes(program);
    std::vector<Lifetime> scanned;
    const std::vector<bool> in_defaults = used_by_defaults(program);
    for (uint32_t id = 0; id < program.registers.size(); ++id) {
        const Register& r = program.reg(id);
        if (!r.varying || r.type.is_unsized()) continue;
        if (r.kind == Register::Kind::Parameter || r.kind == Register::Kind::Global || in_defaults[id]) {
            slots.first[id] = slots.planes;
            slots.planes += plane_count(r.type);
        } else if (lives[id].first != Blocks::kNone) {
            scanned.push_back(lives[id]);
        }
    }
    std::sort(scanned.begin(), scanned.end(), [](const Lifetime& a, const Lifetime& b) {
        return std::pair{a.first, a.id} < std::pair{b.first, b.id};
    });
    std::multimap<size_t, uint32_t> alive;           // last use -> register
    std::map<uint32_t, std::vector<uint32_t>> free;  // size -> first planes
    for (const Lifetime& life : scanned) {
        // One that ends where another begins is still read there.
        while (!alive.empty() && alive.begin()->first < life.first) {
            const uint32_t dead = alive.begin()->second;
            free[plane_count(program.reg(dead).type)].push_back(slots.first[dead]);
            alive.erase(alive.begin());
        }
        const uint32_t size = plane_count(program.reg(life.id).type);
        std::vector<uint32_t>& places = free[size];
        if (places.empty()) {
            slots.first[life.id] = slots.planes;
            slots.planes += size;
        } else {
            slots.first[life.id] = places.back();
            places.pop_back();
        }
        alive.emplace(life.last, life.id);
    }
    return slots;
}

}  // namespace trapeze::vm
