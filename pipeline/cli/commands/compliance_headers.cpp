/// What the compliance page says of the headers for shaders.
#include "pipeline/cli/commands/compliance_notes.h"

namespace trapeze {
namespace {

constexpr HeaderNote kHeaders[] = {
    {"antialiasing.h", "filterwidth.h, noises.h, patterns.h", "functions of single studios under this name"},
    {"displace.h", "Displace", ""},
    {"filterwidth.h", "MINFILTWIDTH, filterwidth, filterwidthp, fadeout", ""},
    {"locillum.h", "LocIllumOrenNayar, LocIllumWardAnisotropic, LocIllumGlossy", "further reflection models"},
    {"material.h",
     "MaterialMatte, MaterialClay, MaterialPlastic, MaterialThinPlastic, MaterialRoughMetal, MaterialBrushedMetal, "
     "MaterialShinyMetal, MaterialShinyPlastic, MaterialCeramic, MaterialGlass",
     "jitter and number of rays of glass are not used; rays are traced only where the program traces them"},
    {"materials.h", "material.h", "functions of single studios under this name"},
    {"noises.h",
     "snoise, snoisexy, vsnoise, snoisept, filteredsnoise, filteredvsnoise, filteredsnoiset, VLNoise, filteredVLNoise, fBm, "
     "vfBm, VLfBm, turbulence, fBm_default, vfBm_default, VLfBm_default, turbulence_default, voronoi_f1_2d, "
     "voronoi_f1f2_2d, voronoi_f1_3d, voronoi_f1f2_3d",
     "variants with a parameter of time, but filteredsnoiset"},
    {"normals.h", "shadingnormal", ""},
    {"oak.h", "oaktexture", ""},
    {"patterns.h",
     "boxstep, sqr, filteredabs, smoothstepintegral, filteredsmoothstep, pulse, filteredpulse, pulsetrain, "
     "pulsetrainintegral, filteredpulsetrain, smoothpulse, filteredsmoothpulse, smoothpulsetrain, varyEach, tilepattern, "
     "basicbrick",
     "counts of pulses"},
    {"project.h",
     "array_to_mx, spherical_projection, cylindrical_projection, ProjectTo2D, GetColorTextureAndAlpha, "
     "GetFloatTextureAndAlpha, ApplyColorTextureOver, ApplyFloatTextureOver",
     "bump maps"},
    {"pshad.h", "PSHAD_PARAMS, DEFAULT_PSHAD_PARAMS, GET_PSHAD", ""},
    {"pxslRayUtil.h", "pxslUtil.h, reflections.h", "its own functions: none are published"},
    {"pxslRemap.h", "pxslBiasF, pxslGainF, pxslContrastF", "remapping of colours"},
    {"pxslUtil.h",
     "pxslLooseFilterWidth, pxslTightFilterWidth, pxslFilterWidth, pxslFilteredFNoise, pxslFilteredCNoise, "
     "pxslFilteredVNoise, pxslBimix",
     "variation of colours; the wider filter of displacements"},
    {"rayserver.h", "raysphere.h", "a server of rays: rays are the program's own"},
    {"raysphere.h", "raysphere", ""},
    {"reflections.h",
     "ENVPARAMS, DECLARE_ENVPARAMS, DECLARE_DEFAULTED_ENVPARAMS, Environment, ReflMap, SampleEnvironment",
     "the number of rays (samples) among the parameters"},
    {"rmannotes.h", "rmannotes.sl", ""},
    {"rmannotes.sl",
     "blend, intersection, union, difference, complement, pulse, repeat, whichtile, odd, even, snoise, snoise2, udn, udn2, "
     "rotate2d, topolar2d, fromPolar2d",
     "noises of more dimensions"},
    {"textures.h", "project.h", "functions of single studios under this name"},
    {"voronoi.h", "noises.h", ""},
    {"wood.h", "oak.h", "functions of single studios under this name"},
};

}  // namespace

std::span<const HeaderNote> header_notes() {
    return kHeaders;
}

}  // namespace trapeze
