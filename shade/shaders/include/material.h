/* Whole appearances, to be multiplied by the opacity: what light a surface of a colour sends to the eye. Nf is of unit length and
   faces the eye. */
#ifndef MATERIAL_H
#define MATERIAL_H 1

#include "locillum.h"
#include "reflections.h"

color MaterialMatte(normal Nf; color basecolor; float Ka, Kd;)
{
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf));
}

/* Facets that scatter: clay, plaster, the moon. */
color MaterialClay(normal Nf; color basecolor; float Ka, Kd, roughness;)
{
    extern vector I;
    return basecolor * (Ka * ambient() + Kd * LocIllumOrenNayar(Nf, -normalize(I), roughness));
}

color MaterialPlastic(normal Nf; color basecolor; float Ka, Kd, Ks, roughness;)
{
    extern vector I;
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, -normalize(I), roughness);
}

/* Plastic that lets light through from behind: lampshades, leaves. */
color MaterialThinPlastic(normal Nf; vector V; color basecolor; float Ka, Kd, Kt, Ks, roughness;)
{
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf) + Kt * diffuse(-Nf)) + Ks * specular(Nf, V, roughness);
}

color MaterialRoughMetal(normal Nf; color basecolor; float Ka, Kd, Ks, roughness;)
{
    extern vector I;
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf) + Ks * specular(Nf, -normalize(I), roughness));
}

/* xdir is along the scratches. */
color MaterialBrushedMetal(normal Nf; color basecolor; float Ka, Kd, Ks; vector xdir; float uroughness, vroughness;)
{
    extern vector I;
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf) +
                        Ks * LocIllumWardAnisotropic(Nf, -normalize(I), xdir, uroughness, vroughness));
}

color MaterialShinyMetal(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, blur; DECLARE_ENVPARAMS;)
{
    extern point P;
    extern vector I;
    vector towards = normalize(I);
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf) + Ks * specular(Nf, -towards, roughness) +
                        SampleEnvironment(P, reflect(towards, Nf), Kr, blur, ENVPARAMS));
}

/* With twosided 0, only the outside mirrors. */
color MaterialShinyMetal(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, blur; uniform float twosided;
                         DECLARE_ENVPARAMS;)
{
    extern vector I;
    extern normal N;
    float kr = Kr;
    if (twosided == 0 && I.N > 0)
        kr = 0;
    return MaterialShinyMetal(Nf, basecolor, Ka, Kd, Ks, roughness, kr, blur, ENVPARAMS);
}

/* What is mirrored grows towards the silhouette, by the index of refraction. */
color MaterialShinyPlastic(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, blur, ior; DECLARE_ENVPARAMS;)
{
    extern point P;
    extern vector I;
    vector towards = normalize(I), R = 0, T = 0;
    float kr = 0, kt = 0;
    fresnel(towards, Nf, 1 / ior, kr, kt, R, T);
    kr *= Kr;
    return (1 - kr) * basecolor * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * specular(Nf, -towards, roughness) +
           SampleEnvironment(P, R, kr, blur, ENVPARAMS);
}

color MaterialShinyPlastic(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, blur, ior; uniform float twosided;
                           DECLARE_ENVPARAMS;)
{
    extern vector I;
    extern normal N;
    float kr = Kr;
    if (twosided == 0 && I.N > 0)
        kr = 0;
    return MaterialShinyPlastic(Nf, basecolor, Ka, Kd, Ks, roughness, kr, blur, ior, ENVPARAMS);
}

color MaterialCeramic(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, specsharpness;)
{
    extern vector I;
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf)) +
           Ks * LocIllumGlossy(Nf, -normalize(I), roughness / 10, specsharpness);
}

/* Mirrors and bends, by the index of refraction eta; refraction looks at the environment, or along a ray. Jitter and number of
   rays are not used. */
color MaterialGlass(normal Nf; color basecolor; float Ka, Kd, Ks, roughness, Kr, reflblur, Kt, refrblur, eta;
                    color transmitcolor; float refrrayjitter, refrraysamples; DECLARE_ENVPARAMS;)
{
    extern point P;
    extern vector I;
    extern normal N;
    vector towards = normalize(I), R = 0, T = 0;
    float kr = 0, kt = 0, ratio = eta;
    if (I.N < 0)
        ratio = 1 / eta;
    fresnel(towards, Nf, ratio, kr, kt, R, T);
    return basecolor * (Ka * ambient() + Kd * diffuse(Nf)) + Ks * LocIllumGlossy(Nf, -towards, roughness, 0.5) +
           SampleEnvironment(P, normalize(R), kr * Kr, reflblur, ENVPARAMS) +
           transmitcolor * SampleEnvironment(P, normalize(T), kt * Kt, refrblur, ENVPARAMS);
}

#endif
