light fadingpoint(float intensity = 1, nearfade = 0, farfade = 1e6, falloff = 2; color lightcolor = 1; point from = point "shader" (0,0,0);
    output uniform float __nondiffuse = 0; output uniform float __nonspecular = 1; output varying color __unshadowed = 0)
{
    illuminate(from) {
        float d = length(L);
        __unshadowed = intensity * lightcolor * pow(d, -falloff) * (1 - smoothstep(nearfade, farfade, d));
        Cl = __unshadowed * transmission(Ps, from);
    }
}
