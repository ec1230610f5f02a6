/* What shaders use beyond RISpec 3.2: components and arrays assigned whole, casts as in C, commas, texts that
 * are added, functions of later renderers, variables that are not theirs to change. */
#define DECLARE_MAP_PARAMS                   \
    string mapname = "", mapspace = "world"; \
    uniform float mapblur = 0
#define filterwidth(x) (max(abs(Du(x) * du) + abs(Dv(x) * dv), 1e-6))

float sum(float values[]) {
    float i, all = 0;
    for (i = 0; i < arraylength(values); i += 1) all += values[i];
    return all;
}

void split(color c; output float parts[3]) {
    float k;
    for (k = 0; k < 3; k += 1) parts[k] = c[k];
}

color baked(string file; point where; normal facing) {
    color gathered = 0;
    if (texture3d(file, where, facing, "_radiosity", gathered) == 0) gathered = photonmap(file, where, facing);
    return gathered + subsurface(where, facing) + caustic(where, facing);
}

surface dialects(DECLARE_MAP_PARAMS; float weights[3] = {0.2, 0.7, 0.1}; output varying color Cdirect = 0;
                 varying point Pref = point "shader"(0, 0, 0);) {
    uniform string file = mapname + "." + (mapblur > 0 ? "blurred" : "sharp") + ".tex";
    float parts[3], copy[3] = weights, ramp[4] = 1;
    color texel = (color) texture(file, s, t, "blur", mapblur);
    split(texel, parts);
    copy = parts;
    parts = {1, 0.5, 0.25};
    float i, j;
    for (i = 0, j = 2; i < 3; i += 1, j -= 1) copy[i] += parts[j];
    vector shifted = vector(P);
    shifted[2] += sum(copy) * filterwidth(s);
    s = s * 2, t = t * 2;
    Cs *= (float) noise(shifted);

    illuminance("-fill", P, N, PI / 2, "lightcache", "reuse") {
        uniform float nondiffuse = 0;
        L = normalize(L);
        if (1 == lightsource("__nondiffuse", nondiffuse) && nondiffuse < 1) Cdirect += Cl * (L . normalize(N));
    }
    color hit = 0;
    gather("illuminance", P, reflect(I, N), radians(5), 4, "bias", 0.01, "surface:Ci", hit) {
        Cdirect += hit / 4;
    } else {
        Cdirect += 0.1;
    }
    matrix turned = mtransform(mapspace, matrix "shader" 1);
    turned[3][1] = raylevel() + raydepth() + isshadowray();
    if (texel < 0.1 && isoutput(Cdirect)) Cdirect = baked(file, transform(turned, P), N);
    Oi = Os;
    Ci = Oi * (Cs * Cdirect + ramp[1] * occlusion(P, N, 16, "maxdist", 10));
}
