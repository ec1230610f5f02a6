#include "pipeline/rib/requests/primitive_variables.h"

#include <algorithm>

namespace trapeze::rib {
namespace {

/// A variable whose type RISpec fixes, with what it holds; the storage class is the scene's to
/// choose, but for points.
struct StandardVariable {
    std::string_view name;
    ValueType type;
    int array_length = 1;
    bool is_points = false;
};

/// RISpec, table 5.1: what dicing and shading look for by name.
constexpr StandardVariable kStandard[] = {
    {"P", ValueType::Point, 1, true},  {"Pw", ValueType::HPoint, 1, true},
    {"Pz", ValueType::Float, 1, true}, {"N", ValueType::Normal},
    {"Np", ValueType::Normal},         {"Cs", ValueType::Color},
    {"Os", ValueType::Color},          {"s", ValueType::Float},
    {"t", ValueType::Float},           {"st", ValueType::Float, 2},
    {"width", ValueType::Float},       {"constantwidth", ValueType::Float},
};

/// Lists have one value for a name at most.
void remove(ParameterList& list, std::string_view name) {
    std::erase_if(list.values, [&](const Parameter& p) { return p.name == name; });
}

/// Later stages know RISpec's variables by name: scenes may not declare them as something else. A type with
/// as many floats will do (a vector for N): the numbers are the same, and the standard type is set.
void check_types(RequestReport& report, ParameterList& list) {
    std::erase_if(list.values, [&](Parameter& p) {
        for (const StandardVariable& standard : kStandard) {
            if (p.name != standard.name) continue;
            Declaration own{p.declaration.storage, standard.type, standard.array_length};
            if (standard.is_points) own.storage = StorageClass::Vertex;
            if (p.is_string() || p.declaration.floats_per_item() != own.floats_per_item()) {
                report.error(in_quotes(p.name) + " is declared with another type than its own; left out");
                return true;
            }
            p.declaration = own;
            return false;
        }
        return false;
    });
}

/// Surfaces have s and t; "st" is a pair of them for each item. With an "s" or a "t" beside it, the one that
/// comes first in the list counts, as with any name that is given twice.
void split_st(RequestReport& report, ParameterList& list) {
    const Parameter* st = list.find("st");
    if (!st) return;
    Declaration declaration = st->declaration;
    declaration.array_length = 1;
    Parameter s{"s", declaration, {}, {}}, t{"t", declaration, {}, {}};
    s.floats.reserve(st->floats.size() / 2), t.floats.reserve(st->floats.size() / 2);
    for (size_t i = 0; i + 1 < st->floats.size(); i += 2)
        s.floats.push_back(st->floats[i]), t.floats.push_back(st->floats[i + 1]);
    const auto place = st - list.values.data();
    for (Parameter* const half : {&s, &t}) {
        const Parameter* const given = list.find(half->name);
        const bool comes_first = given && given - list.values.data() < place;
        if (given)
            report.warn_once(in_quotes(half->name) + " is given twice, once in \"st\"; the first counts",
                             "repeated-parameter");
        if (!comes_first) list.set(std::move(*half));
    }
    remove(list, "st");
}

/// "Np", the normal of a face (RISpec, table 5.1), is its "N" where none is given.
void take_planar_normals(ParameterList& list) {
    const Parameter* planar = list.find("Np");
    if (!planar) return;
    Parameter normals = *planar;
    normals.name = "N";
    remove(list, "Np");
    if (!list.find("N")) list.set(std::move(normals));
}

/// A point at infinity cannot be diced.
void check_weights(const Parameter& pw) {
    for (size_t i = 3; i < pw.floats.size(); i += 4)
        if (pw.floats[i] == 0)
            throw RequestError{"point " + std::to_string(i / 4) + " of \"Pw\" has the weight 0", {}};
}

/// "P" from "Pw", divided by its weights: for shapes of flat faces, where the weight of a vertex has no other
/// meaning.
Parameter divided_by_weights(const Parameter& pw) {
    Parameter p{"P", {StorageClass::Vertex, ValueType::Point, 1}, {}, {}};
    p.floats.reserve(pw.floats.size() / 4 * 3);
    for (size_t i = 0; i + 3 < pw.floats.size(); i += 4)
        for (size_t k = 0; k < 3; ++k) p.floats.push_back(pw.floats[i + k] / pw.floats[i + 3]);
    return p;
}

/// "P" wins over "Pw", that over "Pz". Weights are kept for patches alone, which are rational with them.
void choose_points(RequestReport& report, ParameterList& list, PointForm form) {
    const auto leave_out = [&](const char* name) {
        if (!list.find(name)) return;
        report.error(in_quotes(name) + " is not for this primitive; left out");
        remove(list, name);
    };
    // Mostly there is one form alone.
    size_t forms = 0;
    for (const Parameter& p : list.values) forms += p.name == "P" || p.name == "Pw" || p.name == "Pz";
    if (forms == 0 || (forms == 1 && form != PointForm::None && list.find("P"))) return;
    if (form == PointForm::None) leave_out("P"), leave_out("Pw");
    if (form != PointForm::Patch) leave_out("Pz");
    if (list.find("P")) remove(list, "Pw"), remove(list, "Pz");
    const Parameter* pw = list.find("Pw");
    if (!pw) return;
    check_weights(*pw);
    remove(list, "Pz");
    if (form == PointForm::Patch) return;
    Parameter p = divided_by_weights(*list.find("Pw"));
    remove(list, "Pw");
    list.set(std::move(p));
}

/// Heights over a regular grid of a patch mesh, which spans the unit square (RISpec 5.2).
void expand_pz(ParameterList& list, const Topology& topology) {
    const Parameter* pz = list.find("Pz");
    const auto* mesh = std::get_if<PatchMesh>(&topology);
    if (!pz || !mesh) return;
    Parameter p{"P", {StorageClass::Vertex, ValueType::Point, 1}, {}, {}};
    p.floats.reserve(pz->floats.size() * 3);
    for (size_t i = 0; i < pz->floats.size(); ++i) {
        const auto u = static_cast<float>(i % mesh->nu), v = static_cast<float>(i / mesh->nu);
        p.floats.push_back(u / static_cast<float>(mesh->nu - 1));
        p.floats.push_back(v / static_cast<float>(mesh->nv - 1));
        p.floats.push_back(pz->floats[i]);
    }
    remove(list, "Pz");
    list.set(std::move(p));
}

/// Another class that wants as many values of the shape as there are. Where classes want equally many, the
/// first of the list is taken.
std::optional<StorageClass> class_of_count(size_t count, const VariableCounts& counts) {
    if (count == 1) return StorageClass::Constant;
    for (const auto storage :
         {StorageClass::Vertex, StorageClass::FaceVarying, StorageClass::Varying, StorageClass::Uniform})
        if (static_cast<size_t>(counts.of(storage)) == count) return storage;
    return {};
}

/// Whether the variable has what its class wants of the shape, or can be given it: as many values as another
/// class wants are of that class (one is for the whole shape), and values beyond those wanted are left over.
/// Throws where points are too few.
bool fit_to_shape(RequestReport& report, Parameter& p, const VariableCounts& counts) {
    const bool points = p.name == "P" || p.name == "Pw";
    const auto item =
        static_cast<size_t>(p.is_string() ? p.declaration.array_length : p.declaration.floats_per_item());
    const size_t got = (p.is_string() ? p.strings.size() : p.floats.size()) / item;
    const auto wanted = static_cast<size_t>(counts.of(p.declaration.storage));
    if (got == wanted) return true;
    const std::string text = in_quotes(p.name) + " has " + std::to_string(got) +
                             (points ? " points" : " values") + ", needs " + std::to_string(wanted);
    if (const auto storage = points ? std::nullopt : class_of_count(got, counts)) {
        p.declaration.storage = *storage;
        report.warn_once(text + "; it is taken as " + std::string(name_of(*storage)), "variable-class");
        return true;
    }
    if (got > wanted && wanted > 0) {
        (p.is_string() ? p.strings.resize(wanted) : p.floats.resize(wanted * item));
        report.warn_once(text + "; the rest is left over", "surplus-values");
        return true;
    }
    if (points) throw RequestError{text, {}};
    report.error(text + "; the variable is left out");
    return false;
}

}  // namespace

/// First of two steps: types, and which points count, do not depend on the shape; counts do
/// (checked_variables), and polygons learn theirs from the points read here.
ParameterList read_variables(RequestContext& context, ArgumentCursor& cursor, PointForm form) {
    ParameterList list = context.parameters(cursor);
    if (list.values.empty()) return list;
    check_types(context.report, list);
    take_planar_normals(list);
    choose_points(context.report, list, form);
    return list;
}

ParameterList read_variables_with_points(RequestContext& context, ArgumentCursor& cursor, PointForm form) {
    ParameterList list = read_variables(context, cursor, form);
    if (point_count_of(list) == 0) throw RequestError{"\"P\" is missing", {}};
    return list;
}

/// At most one of the three is left in a list by choose_points().
int point_count_of(const ParameterList& list) {
    for (const char* name : {"P", "Pw", "Pz"})
        if (const Parameter* p = list.find(name))
            return static_cast<int>(p->floats.size() / static_cast<size_t>(p->declaration.floats_per_item()));
    return 0;
}

/// In this order: heights become points before points are counted, and "st" is split once its length is
/// right.
ParameterList checked_variables(RequestReport& report, ParameterList list, const Topology& topology) {
    if (list.values.empty()) return list;
    expand_pz(list, topology);
    const VariableCounts counts = variable_counts(topology);
    std::erase_if(list.values, [&](Parameter& p) { return !fit_to_shape(report, p, counts); });
    split_st(report, list);
    return list;
}

}  // namespace trapeze::rib
