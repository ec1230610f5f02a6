/* Rings and grain of ring-porous wood, the trunk along z. */
#ifndef OAK_H
#define OAK_H 1

#include "noises.h"
#include "patterns.h"

/* 0 in early wood to 1 in dark late wood and pores. Rings wobble with the trunk and with the angle and are of uneven width;
   ringy and grainy say how much of each shows. */
float oaktexture(point Pshad; float dPshad, ringfreq, ringunevenness, grainfreq, ringnoise, ringnoisefreq, trunkwobble,
                 trunkwobblefreq, angularwobble, angularwobblefreq, ringy, grainy;)
{
    point at = Pshad + ringnoise * vfBm(Pshad * ringnoisefreq, dPshad * ringnoisefreq, 2, 4, 0.5);
    float height = zcomp(Pshad) * trunkwobblefreq;
    at += trunkwobble * vector(snoisexy(height, 0.5), snoisexy(height, 6.5), 0);

    float r = sqrt(xcomp(at) * xcomp(at) + ycomp(at) * ycomp(at)) * ringfreq;
    float theta = atan(ycomp(at), xcomp(at));
    vector about = angularwobblefreq * vector(cos(theta), sin(theta), 0.1 * zcomp(at));
    r += angularwobble * smoothstep(0, 5, r) * snoise(point(xcomp(about), ycomp(about), zcomp(about)));
    r += ringunevenness * snoisexy(r, 0.5);

    float width = filterwidth(r), phase = mod(r, 1);
    float ring = fadeout(smoothpulse(0.1, 0.55, 0.7, 0.95, phase), 0.4, 1, width);

    point pores = point(grainfreq * xcomp(Pshad), grainfreq * ycomp(Pshad), grainfreq * 0.05 * zcomp(Pshad));
    float porewidth = dPshad * grainfreq;
    float grain = fadeout(smoothstep(0.55, 0.75, float noise(pores)), 0.2, 1, porewidth) * (0.3 + 0.7 * ring);

    return clamp(mix(ringy * ring, 1, grainy * grain), 0, 1);
}

#endif
