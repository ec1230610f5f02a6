#include "noises.h"
/* Cellular pattern with an output variable for compositing. */
surface cells(float Ka = 1, Kd = .8; float freq = 4; float jitter = 1;
              color dark = color "rgb" (.1, .05, 0), light = color "hsv" (.1, .6, .9);
              output varying float cell_distance = 0; output varying point cell_centre = 0)
{
    point PP = freq * transform("object", P);
    voronoi(PP, jitter, cell_distance, cell_centre);
    color Ct = mix(dark, light, smoothstep(0, 1, cell_distance));
    Ct *= color cellnoise(cell_centre);
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Oi * Ct * (Ka * ambient() + Kd * diffuse(Nf));
}
