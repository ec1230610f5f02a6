#include "shade/rsl/analysis/builtins.h"

#include <unordered_map>

namespace trapeze::rsl {
namespace {

// To add a function: a row for each of its overloads here, a row in operations/op_table.def if none of the
// operations there computes it, and a kernel (vm/kernels) or a function that asks the context (vm/*_ops.cpp).
//
// Overloads of a name stand together, the preferred one first: where nothing says which result is wanted, the
// first whose arguments fit best is taken. xcomp and its like are Component and SetComponent with the number
// that their name says; those of transform with one space name have the current space for the other.
// Every row is {name, result, parameters, operation, last resort}; builtins.h explains the letters. Functions
// of later renderers have Op::Unavailable: a call compiles with one warning, and gives 0, an empty text or,
// as the distance to what a ray hits, 1e30.
constexpr Builtin kBuiltins[] = {
    // Mathematics (RISpec 3.2, section 15.1).
    {"radians", 'f', "f", Op::Radians},
    {"degrees", 'f', "f", Op::Degrees},
    {"sin", 'f', "f", Op::Sin},
    {"cos", 'f', "f", Op::Cos},
    {"tan", 'f', "f", Op::Tan},
    {"asin", 'f', "f", Op::Asin},
    {"acos", 'f', "f", Op::Acos},
    {"atan", 'f', "f", Op::Atan},
    {"atan", 'f', "ff", Op::Atan2},
    {"pow", 'f', "ff", Op::Pow},
    {"pow", 'c', "cf", Op::Pow, true},
    {"pow", 'c', "cc", Op::Pow, true},
    {"pow", 'p', "pf", Op::Pow, true},
    {"pow", 'v', "vf", Op::Pow, true},
    {"exp", 'f', "f", Op::Exp},
    {"log", 'f', "f", Op::Log},
    {"log", 'f', "ff", Op::LogBase},
    {"erf", 'f', "f", Op::Erf},  // PRMan's
    {"erfc", 'f', "f", Op::Erfc},
    {"sqrt", 'f', "f", Op::Sqrt},
    {"inversesqrt", 'f', "f", Op::InverseSqrt},
    {"abs", 'f', "f", Op::Abs},
    {"sign", 'f', "f", Op::Sign},
    {"floor", 'f', "f", Op::Floor},
    {"ceil", 'f', "f", Op::Ceil},
    {"round", 'f', "f", Op::Round},
    {"mod", 'f', "ff", Op::Mod},
    {"min", 'f', "ff+", Op::Min},
    {"min", 'c', "cc+", Op::Min},
    {"min", 'p', "pp+", Op::Min},
    {"min", 'v', "vv+", Op::Min},
    {"min", 'n', "nn+", Op::Min},
    {"max", 'f', "ff+", Op::Max},
    {"max", 'c', "cc+", Op::Max},
    {"max", 'p', "pp+", Op::Max},
    {"max", 'v', "vv+", Op::Max},
    {"max", 'n', "nn+", Op::Max},
    {"clamp", 'f', "fff", Op::Clamp},
    {"clamp", 'c', "ccc", Op::Clamp},
    {"clamp", 'p', "ppp", Op::Clamp},
    {"clamp", 'v', "vvv", Op::Clamp},
    {"clamp", 'n', "nnn", Op::Clamp},
    {"mix", 'f', "fff", Op::Mix},
    {"mix", 'c', "ccf", Op::Mix},
    {"mix", 'p', "ppf", Op::Mix},
    {"mix", 'v', "vvf", Op::Mix},
    {"mix", 'n', "nnf", Op::Mix},
    {"mix", 'c', "ccc", Op::Mix},
    {"mix", 'p', "ppp", Op::Mix},
    {"mix", 'v', "vvv", Op::Mix},
    {"mix", 'n', "nnn", Op::Mix},
    {"mix", 'p', "ppc", Op::Mix},
    {"mix", 'v', "vvc", Op::Mix},
    {"mix", 'n', "nnc", Op::Mix},
    {"step", 'f', "ff", Op::Step},
    {"smoothstep", 'f', "fff", Op::SmoothStep},
    {"filterstep", 'f', "ff*", Op::FilterStep},
    {"filterstep", 'f', "fff*", Op::FilterStep},
    {"spline", 'f', "fffff+", Op::Spline},
    {"spline", 'c', "fcccc+", Op::Spline},
    {"spline", 'p', "fpppp+", Op::Spline},
    {"spline", 'v', "fvvvv+", Op::Spline},
    {"spline", 'f', "sfffff+", Op::Spline},
    {"spline", 'c', "sfcccc+", Op::Spline},
    {"spline", 'p', "sfpppp+", Op::Spline},
    {"spline", 'v', "sfvvvv+", Op::Spline},
    {"spline", 'f', "ff[", Op::Spline},
    {"spline", 'c', "fc[", Op::Spline},
    {"spline", 'p', "fp[", Op::Spline},
    {"spline", 'v', "fv[", Op::Spline},
    {"spline", 'f', "sff[", Op::Spline},
    {"spline", 'c', "sfc[", Op::Spline},
    {"spline", 'p', "sfp[", Op::Spline},
    {"spline", 'v', "sfv[", Op::Spline},
    {"Du", 'f', "f", Op::Du},
    {"Du", 'c', "c", Op::Du},
    {"Du", 'v', "v", Op::Du},
    {"Du", 'v', "p", Op::Du},
    {"Du", 'v', "n", Op::Du},
    {"Dv", 'f', "f", Op::Dv},
    {"Dv", 'c', "c", Op::Dv},
    {"Dv", 'v', "v", Op::Dv},
    {"Dv", 'v', "p", Op::Dv},
    {"Dv", 'v', "n", Op::Dv},
    {"Deriv", 'f', "ff", Op::Deriv},
    {"Deriv", 'c', "cf", Op::Deriv},
    {"Deriv", 'v', "vf", Op::Deriv},
    {"Deriv", 'v', "pf", Op::Deriv},
    {"Deriv", 'v', "nf", Op::Deriv},
    {"random", 'f', "", Op::Random},
    {"random", 'c', "", Op::Random},
    {"random", 'p', "", Op::Random},
    {"random", 'v', "", Op::Random},
    {"noise", 'f', "f", Op::Noise},
    {"noise", 'f', "ff", Op::Noise},
    {"noise", 'f', "p", Op::Noise},
    {"noise", 'f', "pf", Op::Noise},
    {"noise", 'c', "f", Op::Noise},
    {"noise", 'c', "ff", Op::Noise},
    {"noise", 'c', "p", Op::Noise},
    {"noise", 'c', "pf", Op::Noise},
    {"noise", 'p', "f", Op::Noise},
    {"noise", 'p', "ff", Op::Noise},
    {"noise", 'p', "p", Op::Noise},
    {"noise", 'p', "pf", Op::Noise},
    {"noise", 'v', "f", Op::Noise},
    {"noise", 'v', "ff", Op::Noise},
    {"noise", 'v', "p", Op::Noise},
    {"noise", 'v', "pf", Op::Noise},
    {"cellnoise", 'f', "f", Op::CellNoise},
    {"cellnoise", 'f', "ff", Op::CellNoise},
    {"cellnoise", 'f', "p", Op::CellNoise},
    {"cellnoise", 'f', "pf", Op::CellNoise},
    {"cellnoise", 'c', "f", Op::CellNoise},
    {"cellnoise", 'c', "ff", Op::CellNoise},
    {"cellnoise", 'c', "p", Op::CellNoise},
    {"cellnoise", 'c', "pf", Op::CellNoise},
    {"cellnoise", 'p', "f", Op::CellNoise},
    {"cellnoise", 'p', "ff", Op::CellNoise},
    {"cellnoise", 'p', "p", Op::CellNoise},
    {"cellnoise", 'p', "pf", Op::CellNoise},
    {"cellnoise", 'v', "f", Op::CellNoise},
    {"cellnoise", 'v', "ff", Op::CellNoise},
    {"cellnoise", 'v', "p", Op::CellNoise},
    {"cellnoise", 'v', "pf", Op::CellNoise},
    {"pnoise", 'f', "ff", Op::PeriodicNoise},
    {"pnoise", 'f', "ffff", Op::PeriodicNoise},
    {"pnoise", 'f', "pp", Op::PeriodicNoise},
    {"pnoise", 'f', "pfpf", Op::PeriodicNoise},
    {"pnoise", 'c', "ff", Op::PeriodicNoise},
    {"pnoise", 'c', "ffff", Op::PeriodicNoise},
    {"pnoise", 'c', "pp", Op::PeriodicNoise},
    {"pnoise", 'c', "pfpf", Op::PeriodicNoise},
    {"pnoise", 'p', "ff", Op::PeriodicNoise},
    {"pnoise", 'p', "ffff", Op::PeriodicNoise},
    {"pnoise", 'p', "pp", Op::PeriodicNoise},
    {"pnoise", 'p', "pfpf", Op::PeriodicNoise},
    {"pnoise", 'v', "ff", Op::PeriodicNoise},
    {"pnoise", 'v', "ffff", Op::PeriodicNoise},
    {"pnoise", 'v', "pp", Op::PeriodicNoise},
    {"pnoise", 'v', "pfpf", Op::PeriodicNoise},

    // Geometry (15.2).
    {"xcomp", 'f', "v", Op::Component},
    {"ycomp", 'f', "v", Op::Component},
    {"zcomp", 'f', "v", Op::Component},
    {"setxcomp", 'w', "Pf", Op::SetComponent},
    {"setycomp", 'w', "Pf", Op::SetComponent},
    {"setzcomp", 'w', "Pf", Op::SetComponent},
    {"length", 'f', "v", Op::Length},
    {"normalize", 'v', "v", Op::Normalize},
    {"distance", 'f', "pp", Op::Distance},
    {"ptlined", 'f', "ppp", Op::LineDistance},
    {"rotate", 'p', "pfpp", Op::Rotate},
    {"rotate", 'v', "vfpp", Op::Rotate},
    {"rotate", 'm', "mfv", Op::RotateMatrix},
    {"area", 'f', "p", Op::Area},
    {"area", 'f', "ps", Op::Area},
    {"gridmin", 'f', "f", Op::GridMin},  // PRMan's
    {"gridmax", 'f', "f", Op::GridMax},
    {"gridavg", 'f', "f", Op::GridAverage},
    {"faceforward", 'v', "vv", Op::FaceForward},
    {"faceforward", 'v', "vvv", Op::FaceForward},
    {"reflect", 'v', "vv", Op::Reflect},
    {"refract", 'v', "vvf", Op::Refract},
    {"fresnel", 'w', "vvfFF", Op::Fresnel},
    {"fresnel", 'w', "vvfFFVV", Op::Fresnel},
    {"transform", 'p', "sp", Op::TransformPointNamed},
    {"transform", 'p', "ssp", Op::TransformPointNamed},
    {"transform", 'p', "smp", Op::TransformPointNamed},
    {"transform", 'p', "mp", Op::TransformPoint},
    // As BMRT and the books call it.
    {"ptransform", 'p', "sp", Op::TransformPointNamed},
    {"ptransform", 'p', "ssp", Op::TransformPointNamed},
    {"ptransform", 'p', "smp", Op::TransformPointNamed},
    {"ptransform", 'p', "mp", Op::TransformPoint},
    {"vtransform", 'v', "sv", Op::TransformVectorNamed},
    {"vtransform", 'v', "ssv", Op::TransformVectorNamed},
    {"vtransform", 'v', "smv", Op::TransformVectorNamed},
    {"vtransform", 'v', "mv", Op::TransformVector},
    {"ntransform", 'n', "sn", Op::TransformNormalNamed},
    {"ntransform", 'n', "ssn", Op::TransformNormalNamed},
    {"ntransform", 'n', "smn", Op::TransformNormalNamed},
    {"ntransform", 'n', "mn", Op::TransformNormal},
    {"depth", 'f', "p", Op::Depth},
    {"calculatenormal", 'n', "p", Op::CalculateNormal},

    // Colours (15.3).
    {"comp", 'f', "cf", Op::Component},
    {"comp", 'f', "vf", Op::Component},
    {"comp", 'f', "mff", Op::MatrixElement},
    {"setcomp", 'w', "Cff", Op::SetComponent},
    {"setcomp", 'w', "Pff", Op::SetComponent},
    {"setcomp", 'w', "Mfff", Op::SetMatrixElement},
    {"ctransform", 'c', "sc", Op::ConvertColor},
    {"ctransform", 'c', "ssc", Op::ConvertColor},

    // Matrices (15.4).
    {"mtransform", 'm', "sm", Op::TransformMatrixNamed},
    {"mtransform", 'm', "ssm", Op::TransformMatrixNamed},
    {"mtransform", 'm', "smm", Op::TransformMatrixNamed},
    {"mtransform", 'm', "mm", Op::TransformMatrixNamed},
    {"determinant", 'f', "m", Op::Determinant},
    {"translate", 'm', "mv", Op::TranslateMatrix},
    {"scale", 'm', "mv", Op::ScaleMatrix},

    // Strings (15.5).
    {"concat", 's', "ss+", Op::Concat},
    {"printf", 'w', "s.", Op::Print},
    {"format", 's', "s.", Op::Format},
    {"match", 'f', "ss", Op::Match},

    // Light (15.6).
    {"ambient", 'c', "", Op::Ambient},
    {"diffuse", 'c', "n", Op::Diffuse},
    {"specular", 'c', "nvf", Op::Specular},
    {"specularbrdf", 'c', "vnvf", Op::SpecularBrdf},
    {"phong", 'c', "nvf", Op::Phong},
    {"trace", 'c', "pv*", Op::Trace},
    {"trace", 'f', "pv*", Op::Trace, true},  // Kr * trace(P, R) is a colour, as in shaders of RISpec's time
    {"transmission", 'c', "pp*", Op::Transmission},
    {"visibility", 'c', "pp", Op::Visibility},
    {"visibility", 'f', "pp", Op::Visibility},
    {"occlusion", 'f', "pnf*", Op::Occlusion},
    {"occlusion", 'f', "spnf*", Op::Occlusion},
    {"indirectdiffuse", 'c', "pnf*", Op::IndirectDiffuse},
    {"indirectdiffuse", 'c', "sv*", Op::IndirectDiffuse},
    {"rayinfo", 'f', "s?", Op::RayInfo},
    {"raylevel", 'f', "", Op::RayLevel},
    {"raydepth", 'f', "", Op::RayLevel},
    {"isindirectray", 'f', "", Op::IsIndirectRay},
    {"isshadowray", 'f', "", Op::IsShadowRay},
    {"raylabel", 's', "", Op::RayLabel},

    // Maps (15.7).
    {"texture", 'f', "s*", Op::Texture},
    {"texture", 'c', "s*", Op::Texture},
    {"texture", 'f', "sff*", Op::Texture},
    {"texture", 'c', "sff*", Op::Texture},
    {"texture", 'f', "sffffffff*", Op::Texture},
    {"texture", 'c', "sffffffff*", Op::Texture},
    {"environment", 'f', "sv*", Op::Environment},
    {"environment", 'c', "sv*", Op::Environment},
    {"environment", 'f', "svvvv*", Op::Environment},
    {"environment", 'c', "svvvv*", Op::Environment},
    {"shadow", 'f', "sp*", Op::Shadow},
    {"shadow", 'c', "sp*", Op::Shadow},
    {"shadow", 'f', "spppp*", Op::Shadow},
    {"shadow", 'c', "spppp*", Op::Shadow},
    {"bump", 'p', "snvv*", Op::Bump},
    {"bump", 'p', "snvvff*", Op::Bump},
    {"bump", 'p', "snvvffffffff*", Op::Bump},
    {"textureinfo", 'f', "ss?", Op::TextureInfo},

    // Point clouds, as PRMan has them.
    {"bake3d", 'f', "sspn*", Op::Bake3d},
    {"texture3d", 'f', "spn*", Op::Texture3d},

    // Messages (15.8).
    {"atmosphere", 'f', "s?", Op::AtmosphereMessage},
    {"displacement", 'f', "s?", Op::DisplacementMessage},
    {"lightsource", 'f', "s?", Op::LightMessage},
    {"islightcategory", 'f', "s", Op::IsLightCategory},  // 3Delight's
    {"surface", 'f', "s?", Op::SurfaceMessage},
    {"incident", 'f', "s?", Op::IncidentMessage},
    {"opposite", 'f', "s?", Op::OppositeMessage},
    {"attribute", 'f', "s?", Op::AttributeMessage},
    {"getvar", 'f', "s?", Op::VariableMessage},  // 3Delight's, of the object that is shaded
    {"readprimvar", 'f', "s?", Op::VariableMessage},
    {"option", 'f', "s?", Op::OptionMessage},
    {"rendererinfo", 'f', "s?", Op::RendererInfo},
    {"shadername", 's', "", Op::ShaderName},
    {"shadername", 's', "s", Op::ShaderName},

    // Questions about variables.
    {"arraylength", 'f', "#", Op::ArrayLength},
    // Resizable arrays (PRMan's).
    {"capacity", 'f', "#", Op::ArrayCapacity},
    {"push", 'w', "F[f", Op::ArrayPush},
    {"push", 'w', "C[c", Op::ArrayPush},
    {"push", 'w', "P[p", Op::ArrayPush},
    {"push", 'w', "V[v", Op::ArrayPush},
    {"push", 'w', "N[n", Op::ArrayPush},
    {"push", 'w', "M[m", Op::ArrayPush},
    {"push", 'w', "S[s", Op::ArrayPush},
    {"pop", 'f', "F[", Op::ArrayPop},
    {"pop", 'c', "C[", Op::ArrayPop},
    {"pop", 'p', "P[", Op::ArrayPop},
    {"pop", 'v', "V[", Op::ArrayPop},
    {"pop", 'n', "N[", Op::ArrayPop},
    {"pop", 'm', "M[", Op::ArrayPop},
    {"pop", 's', "S[", Op::ArrayPop},
    {"resize", 'w', "F[f", Op::ArrayResize},
    {"resize", 'w', "C[f", Op::ArrayResize},
    {"resize", 'w', "P[f", Op::ArrayResize},
    {"resize", 'w', "V[f", Op::ArrayResize},
    {"resize", 'w', "N[f", Op::ArrayResize},
    {"resize", 'w', "M[f", Op::ArrayResize},
    {"resize", 'w', "S[f", Op::ArrayResize},
    {"reserve", 'w', "F[f", Op::ArrayReserve},
    {"reserve", 'w', "C[f", Op::ArrayReserve},
    {"reserve", 'w', "P[f", Op::ArrayReserve},
    {"reserve", 'w', "V[f", Op::ArrayReserve},
    {"reserve", 'w', "N[f", Op::ArrayReserve},
    {"reserve", 'w', "M[f", Op::ArrayReserve},
    {"reserve", 'w', "S[f", Op::ArrayReserve},
    {"isoutput", 'f', ".", Op::IsOutput},

    // Functions of later renderers (bakes, photon maps, older ray tracers).
    {"bake", 'f', ".", Op::Unavailable},
    {"photonmap", 'c', ".", Op::Unavailable},
    {"caustic", 'c', ".", Op::Unavailable},
    {"irradiance", 'c', ".", Op::Unavailable},
    {"subsurface", 'c', ".", Op::Unavailable},
    {"areashadow", 'f', ".", Op::Unavailable},
    {"areashadow", 'c', ".", Op::Unavailable},
    {"fulltrace", 'c', ".", Op::Unavailable},
    {"fulltrace", 'f', ".", Op::Unavailable},
    {"rayhittest", 'f', ".", Op::Unavailable},
    // Noises and textures of PRMan's later years.
    {"ptexture", 'f', ".", Op::Unavailable},
    {"ptexture", 'c', ".", Op::Unavailable},
    {"textureatlas", 'f', ".", Op::Unavailable},
    {"textureatlas", 'c', ".", Op::Unavailable},
    {"wnoise", 'f', ".", Op::Unavailable},
    {"wnoise", 'c', ".", Op::Unavailable},
    {"wnoise", 'p', ".", Op::Unavailable},
    {"wnoise", 'v', ".", Op::Unavailable},
    {"randomgrid", 'f', ".", Op::Unavailable},
    {"randomgrid", 'c', ".", Op::Unavailable},
    {"randomgrid", 'p', ".", Op::Unavailable},
    {"randomgrid", 'v', ".", Op::Unavailable},
    {"randomstrat", 'f', ".", Op::Unavailable},
    {"randomstrat", 'c', ".", Op::Unavailable},
    {"randomstrat", 'p', ".", Op::Unavailable},
    {"randomstrat", 'v', ".", Op::Unavailable},
};

/// Names among the optional arguments of occlusion() and indirectdiffuse() that are followed by a variable to
/// be set.
constexpr std::string_view kSkyOutputs[] = {"environmentcolor", "environmentdir", "hitdist", "occlusion"};
/// Likewise of trace().
constexpr std::string_view kTraceOutputs[] = {"hitdist", "transmission"};
/// Arguments of texture3d() that are no channels.
constexpr std::string_view kCloudInputs[] = {"coordsystem", "filterradius", "filterscale", "maxdepth",
                                             "lerp"};

using ByName = std::unordered_map<std::string_view, std::span<const Builtin>>;

/// The runs of rows that share a name.
/// Made once: a span of rows for every name. That rows of a name stand together is what makes it one span.
/// Views into the table, which is static.
ByName by_name() {
    ByName map;
    const std::span<const Builtin> all(kBuiltins);
    for (size_t first = 0, i = 1; i <= all.size(); ++i)
        if (i == all.size() || all[i].name != all[first].name) {
            map[all[first].name] = all.subspan(first, i - first);
            first = i;
        }
    return map;
}

}  // namespace

std::span<const Builtin> builtins() {
    return kBuiltins;
}

std::span<const Builtin> builtins_named(std::string_view name) {
    // Made at the first call; C++ makes threads that come meanwhile wait.
    static const ByName kByName = by_name();
    const auto entry = kByName.find(name);
    return entry == kByName.end() ? std::span<const Builtin>() : entry->second;
}

bool sets_by_name(const Builtin& builtin, std::string_view name) {
    if (builtin.op == Op::Texture3d) return std::ranges::find(kCloudInputs, name) == std::end(kCloudInputs);
    if (builtin.op == Op::Trace) return std::ranges::find(kTraceOutputs, name) != std::end(kTraceOutputs);
    const bool may = builtin.op == Op::Occlusion || builtin.op == Op::IndirectDiffuse;
    return may && std::ranges::find(kSkyOutputs, name) != std::end(kSkyOutputs);
}

}  // namespace trapeze::rsl
