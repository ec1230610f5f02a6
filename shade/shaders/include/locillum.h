/* Local illumination: sums over lights that take the place of diffuse() and specular(). Nf and V are of unit length. */
#ifndef LOCILLUM_H
#define LOCILLUM_H 1

/* Rough diffuse surfaces [Oren94, the qualitative model]; roughness is the deviation of facets' slopes, in radians. */
color LocIllumOrenNayar(normal N; vector V; float roughness;)
{
    extern point P;
    float variance = roughness * roughness;
    float A = 1 - 0.5 * variance / (variance + 0.33);
    float B = 0.45 * variance / (variance + 0.09);
    float cosview = clamp(V.N, -1, 1);
    vector viewflat = normalize(V - N * cosview);
    color sum = 0;

    illuminance(P, N, PI / 2) {
        float nondiffuse = 0;
        lightsource("__nondiffuse", nondiffuse);
        if (nondiffuse < 1) {
            vector towards = normalize(L);
            float coslight = clamp(towards.N, 0, 1);
            float turn = max(0, viewflat.normalize(towards - N * coslight));
            float high = acos(min(coslight, cosview)), low = acos(max(coslight, cosview));
            sum += (1 - nondiffuse) * Cl * coslight * (A + B * turn * sin(high) * tan(low));
        }
    }
    return sum;
}

/* Highlights of brushed surfaces [Ward92]; the roughnesses are the deviations of slopes along xdir and across. */
color LocIllumWardAnisotropic(normal N; vector V; vector xdir; float xroughness, yroughness;)
{
    extern point P;
    vector X = normalize(xdir - N * (xdir.N)) / xroughness;
    vector Y = normalize(N ^ xdir) / yroughness;
    float cosview = clamp(N.V, 0.0001, 1);
    color sum = 0;

    illuminance(P, N, PI / 2) {
        float nonspecular = 0;
        lightsource("__nonspecular", nonspecular);
        if (nonspecular < 1) {
            vector towards = normalize(L), H = normalize(V + towards);
            float coslight = towards.N;
            if (coslight > 0) {
                float slopes = ((X.H) * (X.H) + (Y.H) * (Y.H)) / (1 + H.N);
                sum += (1 - nonspecular) * Cl * coslight * exp(-2 * slopes) / sqrt(coslight * cosview);
            }
        }
    }
    return sum / (4 * xroughness * yroughness);
}

/* Highlights of glass and liquids, even inside and with a border: sharpness 0 is soft, 1 is an edge. */
color LocIllumGlossy(normal N; vector V; float roughness, sharpness;)
{
    extern point P;
    float soft = 0.18 * (1 - sharpness);
    color sum = 0;

    illuminance(P, N, PI / 2) {
        float nonspecular = 0;
        lightsource("__nonspecular", nonspecular);
        if (nonspecular < 1) {
            vector H = normalize(normalize(L) + V);
            sum += (1 - nonspecular) * Cl * smoothstep(0.72 - soft, 0.72 + soft, pow(max(0, N.H), 1 / roughness));
        }
    }
    return sum;
}

#endif
