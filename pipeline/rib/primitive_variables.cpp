#include "pipeline/rib/primitive_variables.h"

#include <algorithm>

namespace trapeze::rib {
namespace {

void check_lengths(Reader& reader, ParameterList& list, const Topology& topology) {
    const VariableCounts counts = variable_counts(topology);
    std::erase_if(list.values, [&](const Parameter& p) {
        const bool points = p.name == "P" || p.name == "Pw";
        const size_t item = p.is_string() ? p.declaration.array_length : p.declaration.floats_per_item();
        const size_t got = (p.is_string() ? p.strings.size() : p.floats.size()) / item;
        const size_t wanted = static_cast<size_t>(counts.of(p.declaration.storage));
        if (got == wanted) return false;
        const std::string text = "\"" + p.name + "\" has " + std::to_string(got) +
                                 (points ? " points" : " values") + ", needs " + std::to_string(wanted);
        if (points) throw RequestError{text + "; primitive skipped", {}};
        reader.error(text + "; the variable is left out");
        return true;
    });
}

/// Moves "st" apart.
void split_st(ParameterList& list) {
    const Parameter* st = list.find("st");
    if (!st || st->declaration.floats_per_item() != 2) return;
    Parameter s{"s", st->declaration, {}, {}}, t{"t", st->declaration, {}, {}};
    s.declaration.type = t.declaration.type = ValueType::Float;
    s.declaration.array_length = t.declaration.array_length = 1;
    for (size_t i = 0; i + 1 < st->floats.size(); i += 2)
        s.floats.push_back(st->floats[i]), t.floats.push_back(st->floats[i + 1]);
    std::erase_if(list.values, [](const Parameter& p) { return p.name == "st"; });
    list.set(std::move(s));
    list.set(std::move(t));
}

/// Heights over a regular grid of a patch mesh, which spans the unit square (RISpec 5.2).
void expand_pz(ParameterList& list, const Topology& topology) {
    const Parameter* pz = list.find("Pz");
    const auto* mesh = std::get_if<PatchMesh>(&topology);
    if (!pz || !mesh || list.find("P")) return;
    Parameter p{"P", {StorageClass::Vertex, ValueType::Point, 1}, {}, {}};
    for (size_t i = 0; i < pz->floats.size(); ++i) {
        const auto u = static_cast<float>(i % mesh->nu), v = static_cast<float>(i / mesh->nu);
        p.floats.insert(p.floats.end(), {u / static_cast<float>(mesh->nu - 1),
                                         v / static_cast<float>(mesh->nv - 1), pz->floats[i]});
    }
    std::erase_if(list.values, [](const Parameter& q) { return q.name == "Pz"; });
    list.set(std::move(p));
}

}  // namespace

int point_count_of(const ParameterList& list) {
    for (const char* name : {"P", "Pw", "Pz"})
        if (const Parameter* p = list.find(name))
            return static_cast<int>(p->floats.size() / p->declaration.floats_per_item());
    return 0;
}

ParameterList checked_variables(Reader& reader, ParameterList list, const Topology& topology) {
    split_st(list);
    expand_pz(list, topology);
    check_lengths(reader, list, topology);
    return list;
}

}  // namespace trapeze::rib
