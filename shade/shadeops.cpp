#include "shade/shadeops.h"

#include "shade/kernels.h"

namespace trapeze::shadeops {
namespace {

Plane3 black(PlanePool& pool) {
    const Plane3 planes = pool.take3();
    for (int k = 0; k < 3; ++k) fill(0, planes[k]);
    return planes;
}

}  // namespace

Plane3 ambient(Illumination& lights) {
    const Plane3 sum = black(lights.pool());
    for (const Illumination::Arriving& light : lights.arriving())
        if (light.ambient) kernels::add(light.Cl, sum);
    return sum;
}

Plane3 diffuse(Illumination& lights, ConstPlane3 N) {
    const Plane3 sum = black(lights.pool());
    for (const Illumination::Arriving& light : lights.arriving())
        if (!light.ambient) kernels::add_diffuse(N, light.direction, light.Cl, sum);
    return sum;
}

Plane3 specular(Illumination& lights, ConstPlane3 N, ConstPlane3 V, ConstPlane roughness) {
    const Plane3 sum = black(lights.pool());
    for (const Illumination::Arriving& light : lights.arriving())
        if (!light.ambient) kernels::add_specular(N, V, light.direction, light.Cl, roughness, sum);
    return sum;
}

Plane3 facing_normal(ShaderInput& input) {
    const Plane3 N = input.pool().take3();
    kernels::facing_normal(input.N(), input.I(), N);
    return N;
}

Plane3 toward_viewer(ShaderInput& input) {
    const Plane3 V = input.pool().take3();
    kernels::normalize(input.I(), -1, V);
    return V;
}

}  // namespace trapeze::shadeops
