#include "shade/rsl/analysis/globals.h"

#include <algorithm>

namespace trapeze::rsl {
namespace {

constexpr Storage kUniform = Storage::Uniform, kVarying = Storage::Varying;

// Surfaces may also move P and turn N, as PRMan lets them, and change L and Cl for the rest of a turn of
// illuminance. Ps, the point that is lit, is theirs, too.
constexpr GlobalVariable kSurface[] = {
    {"Cs", Base::Color, kVarying, false},       {"Os", Base::Color, kVarying, false},
    {"P", Base::Point, kVarying, true},         {"Ps", Base::Point, kVarying, false},
    {"dPdu", Base::Vector, kVarying, false},    {"dPdv", Base::Vector, kVarying, false},
    {"N", Base::Normal, kVarying, true},        {"Ng", Base::Normal, kVarying, false},
    {"u", Base::Float, kVarying, false},        {"v", Base::Float, kVarying, false},
    {"du", Base::Float, kVarying, false},       {"dv", Base::Float, kVarying, false},
    {"s", Base::Float, kVarying, false},        {"t", Base::Float, kVarying, false},
    {"L", Base::Vector, kVarying, true},        {"Cl", Base::Color, kVarying, true},
    {"Ol", Base::Color, kVarying, true},        {"E", Base::Point, kUniform, false},
    {"I", Base::Vector, kVarying, false},       {"ncomps", Base::Float, kUniform, false},
    {"time", Base::Float, kUniform, false},     {"dtime", Base::Float, kUniform, false},
    {"dPdtime", Base::Vector, kVarying, false}, {"Ci", Base::Color, kVarying, true},
    {"Oi", Base::Color, kVarying, true}};

// L may be set: lights without illuminate and solar did so. Ns, the surface's normal, is not in the table,
// and widely known.
constexpr GlobalVariable kLight[] = {
    {"P", Base::Point, kVarying, false},      {"dPdu", Base::Vector, kVarying, false},
    {"dPdv", Base::Vector, kVarying, false},  {"N", Base::Normal, kVarying, false},
    {"Ng", Base::Normal, kVarying, false},    {"u", Base::Float, kVarying, false},
    {"v", Base::Float, kVarying, false},      {"du", Base::Float, kVarying, false},
    {"dv", Base::Float, kVarying, false},     {"s", Base::Float, kVarying, false},
    {"t", Base::Float, kVarying, false},      {"L", Base::Vector, kVarying, true},
    {"Ps", Base::Point, kVarying, false},     {"I", Base::Vector, kVarying, false},
    {"Ns", Base::Normal, kVarying, false},    {"E", Base::Point, kUniform, false},
    {"ncomps", Base::Float, kUniform, false}, {"time", Base::Float, kUniform, false},
    {"dtime", Base::Float, kUniform, false},  {"Cl", Base::Color, kVarying, true},
    {"Ol", Base::Color, kVarying, true}};

// RISpec's table of volume shaders, and what it leaves out: what illuminance gives, and the surface that the
// ray comes from.
constexpr GlobalVariable kVolume[] = {
    {"P", Base::Point, kVarying, false},      {"I", Base::Vector, kVarying, false},
    {"E", Base::Point, kUniform, false},      {"L", Base::Vector, kVarying, true},
    {"Cl", Base::Color, kVarying, true},      {"Ol", Base::Color, kVarying, true},
    {"Cs", Base::Color, kVarying, false},     {"Os", Base::Color, kVarying, false},
    {"N", Base::Normal, kVarying, false},     {"Ng", Base::Normal, kVarying, false},
    {"dPdu", Base::Vector, kVarying, false},  {"dPdv", Base::Vector, kVarying, false},
    {"u", Base::Float, kVarying, false},      {"v", Base::Float, kVarying, false},
    {"du", Base::Float, kVarying, false},     {"dv", Base::Float, kVarying, false},
    {"s", Base::Float, kVarying, false},      {"t", Base::Float, kVarying, false},
    {"ncomps", Base::Float, kUniform, false}, {"time", Base::Float, kUniform, false},
    {"dtime", Base::Float, kUniform, false},  {"Ci", Base::Color, kVarying, true},
    {"Oi", Base::Color, kVarying, true}};

// P and N are what a displacement is there to change.
constexpr GlobalVariable kDisplacement[] = {
    {"P", Base::Point, kVarying, true},        {"dPdu", Base::Vector, kVarying, false},
    {"dPdv", Base::Vector, kVarying, false},   {"N", Base::Normal, kVarying, true},
    {"Ng", Base::Normal, kVarying, false},     {"I", Base::Vector, kVarying, false},
    {"E", Base::Point, kUniform, false},       {"u", Base::Float, kVarying, false},
    {"v", Base::Float, kVarying, false},       {"du", Base::Float, kVarying, false},
    {"dv", Base::Float, kVarying, false},      {"s", Base::Float, kVarying, false},
    {"t", Base::Float, kVarying, false},       {"ncomps", Base::Float, kUniform, false},
    {"time", Base::Float, kUniform, false},    {"dtime", Base::Float, kUniform, false},
    {"dPdtime", Base::Vector, kVarying, false}};

// s and t, u and v, which the table leaves out, run over the picture.
constexpr GlobalVariable kImager[] = {
    {"P", Base::Point, kVarying, false},      {"u", Base::Float, kVarying, false},
    {"v", Base::Float, kVarying, false},      {"s", Base::Float, kVarying, false},
    {"t", Base::Float, kVarying, false},      {"Ci", Base::Color, kVarying, true},
    {"Oi", Base::Color, kVarying, true},      {"alpha", Base::Float, kVarying, true},
    {"ncomps", Base::Float, kUniform, false}, {"time", Base::Float, kUniform, false},
    {"dtime", Base::Float, kUniform, false}};

}  // namespace

/// The tables live as long as the program, so that variables may view their names. Tables 12.1 to 12.5 of
/// RISpec 3.2, with what is said above of each.
std::span<const GlobalVariable> global_variables(ShaderKind kind) {
    switch (kind) {
        case ShaderKind::Surface:
            return kSurface;
        case ShaderKind::Displacement:
            return kDisplacement;
        case ShaderKind::Light:
            return kLight;
        case ShaderKind::Volume:
            return kVolume;
        case ShaderKind::Imager:
            return kImager;
    }
    return {};
}

/// A linear search, asked once for each name that a shader uses.
const GlobalVariable* find_global(ShaderKind kind, std::string_view name) {
    const std::span<const GlobalVariable> all = global_variables(kind);
    const auto row =
        std::find_if(all.begin(), all.end(), [&](const GlobalVariable& g) { return g.name == name; });
    return row == all.end() ? nullptr : &*row;
}

}  // namespace trapeze::rsl
