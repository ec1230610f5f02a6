/* A volume that marches along the ray. */
volume smoke(float density = .5, stepsize = .1; uniform float maxsteps = 100; color smokecolor = 1; float freq = 1;)
{
    float smokedensity(point p) {
        extern float density, freq;
        return density * smoothstep(.2, 1, float noise(p * freq));
    }
    color lighting(point p) {
        color c = 0;
        illuminance(p) { extern color Cl; c += Cl; }
        return c;
    }

    float len = length(I);
    vector IN = normalize(I);
    point Worigin = P - I;
    float d = stepsize * random();
    color Cv = 0, Ov = 0;
    uniform float count = 0;
    while (d < len && count < maxsteps) {
        point PP = Worigin + d * IN;
        float tau = smokedensity(PP) * stepsize;
        color dO = 1 - exp(-tau);
        Cv += (1 - Ov) * dO * smokecolor * lighting(PP);
        Ov += (1 - Ov) * dO;
        d += stepsize;
        count += 1;
    }
    Ci = Cv + (1 - Ov) * Ci;
    Oi = Ov + (1 - Ov) * Oi;
}
