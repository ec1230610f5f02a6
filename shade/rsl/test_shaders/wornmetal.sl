#include "noises.h"
surface wornmetal(float Ka = 1, Ks = 1, roughness = .2; float wear = .5; uniform float verbose = 0)
{
    point PP = transform("shader", P);
    float fw = filterwidthp(PP);
    float rust = smoothstep(.2 * wear, .4 * wear, fBm(PP, fw, 5, 2.17, .5));
    vector disp = vsnoise(PP * 20);
    normal Nf = faceforward(normalize(N + .05 * rust * disp), I);
    color metal = Cs * (Ka * ambient() + Ks * specular(Nf, -normalize(I), roughness));
    color rusty = (.4, .2, .1) * diffuse(Nf);
    if (verbose != 0) printf("rust %f\n", rust);
    Ci = Os * mix(metal, rusty, rust);
    Oi = Os;
}
