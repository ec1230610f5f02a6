/* Sums of noises, and cells about scattered points. Noise fades out where it is finer than the filter's width. */
#ifndef NOISES_H
#define NOISES_H 1

#include "filterwidth.h"
#include "patterns.h"

/* Noise about 0, from -1 to 1. */
#ifndef snoise
#define snoise(p) (2 * (float noise(p)) - 1)
#define snoisexy(x, y) (2 * (float noise(x, y)) - 1)
#define vsnoise(p) (2 * (vector noise(p)) - 1)
#endif

#define noisefade(width) (1 - smoothstep(0.2, 0.75, width))
#define filteredsnoise(p, width) (snoise(p) * noisefade(width))
#define filteredvsnoise(p, width) (vsnoise(p) * noisefade(width))

/* The same in four dimensions: a point and a time. */
#define snoisept(p, t) (2 * (float noise(p, t)) - 1)
#define filteredsnoiset(p, width, t) (snoisept(p, t) * noisefade(width))

#define VLNoise(p, scale) (snoise(vsnoise(p) * scale + p))
#define filteredVLNoise(p, width, scale) (filteredsnoise(filteredvsnoise(p, width) * scale + p, width))

/* The name of some versions. */
#define filtered_fBm(p, filtwidth, octaves, lacunarity, gain) fBm(p, filtwidth, octaves, lacunarity, gain)
#define fBm_default(p) fBm(p, filterwidthp(p), 4, 2, 0.5)
#define vfBm_default(p) vfBm(p, filterwidthp(p), 4, 2, 0.5)
#define VLfBm_default(p) VLfBm(p, filterwidthp(p), 4, 2, 0.5, 1.0)
#define turbulence_default(p) turbulence(p, filterwidthp(p), 4, 2, 0.5)

float fBm(point p; float filtwidth; uniform float octaves, lacunarity, gain)
{
    float sum = 0;
    uniform float i, scale = 1, weight = 1;

    for (i = 0; i < octaves; i += 1) {
        sum += weight * filteredsnoise(p * scale, filtwidth * scale);
        weight *= gain;
        scale *= lacunarity;
    }
    return sum;
}

vector vfBm(point p; float filtwidth; uniform float octaves, lacunarity, gain)
{
    vector sum = 0;
    uniform float i, scale = 1, weight = 1;

    for (i = 0; i < octaves; i += 1) {
        sum += weight * filteredvsnoise(p * scale, filtwidth * scale);
        weight *= gain;
        scale *= lacunarity;
    }
    return sum;
}

float VLfBm(point p; float filtwidth; uniform float octaves, lacunarity, gain, distortion)
{
    float sum = 0;
    point at = p;
    uniform float i, scale = 1, weight = 1;

    for (i = 0; i < octaves; i += 1) {
        at = p * scale;
        sum += weight * filteredVLNoise(at, filtwidth * scale, distortion);
        weight *= gain;
        scale *= lacunarity;
    }
    return sum;
}

float turbulence(point p; float filtwidth; uniform float octaves, lacunarity, gain)
{
    float sum = 0;
    uniform float i, scale = 1, weight = 1;

    for (i = 0; i < octaves; i += 1) {
        float width = filtwidth * scale;
        sum += weight * filteredabs(filteredsnoise(p * scale, width), width);
        weight *= gain;
        scale *= lacunarity;
    }
    return sum;
}

/* Each unit cell has one point, jittered about its middle: the nearest ones and their distances. */
void voronoi_f1f2_3d(point P; float jitter; output float f1; output point pos1; output float f2; output point pos2;)
{
    point middle = point(floor(xcomp(P)), floor(ycomp(P)), floor(zcomp(P))) + vector(0.5, 0.5, 0.5);
    uniform float i, j, k;

    f1 = 1000;
    f2 = 1000;
    for (i = -1; i <= 1; i += 1)
        for (j = -1; j <= 1; j += 1)
            for (k = -1; k <= 1; k += 1) {
                point cell = middle + vector(i, j, k);
                point pos = cell + jitter * (vector cellnoise(cell) - 0.5);
                float far = distance(pos, P);
                if (far < f1) {
                    f2 = f1;
                    pos2 = pos1;
                    f1 = far;
                    pos1 = pos;
                } else if (far < f2) {
                    f2 = far;
                    pos2 = pos;
                }
            }
}

void voronoi_f1_3d(point P; float jitter; output float f1; output point pos1;)
{
    float f2 = 0;
    point pos2 = 0;
    voronoi_f1f2_3d(P, jitter, f1, pos1, f2, pos2);
}

void voronoi_f1f2_2d(float ss, tt, jitter; output float f1, spos1, tpos1, f2, spos2, tpos2;)
{
    float smiddle = floor(ss) + 0.5, tmiddle = floor(tt) + 0.5;
    uniform float i, j;

    f1 = 1000;
    f2 = 1000;
    for (i = -1; i <= 1; i += 1)
        for (j = -1; j <= 1; j += 1) {
            float scell = smiddle + i, tcell = tmiddle + j;
            float spos = scell + jitter * (float cellnoise(scell, tcell) - 0.5);
            float tpos = tcell + jitter * (float cellnoise(scell + 23, tcell - 87) - 0.5);
            float far = sqrt((spos - ss) * (spos - ss) + (tpos - tt) * (tpos - tt));
            if (far < f1) {
                f2 = f1;
                spos2 = spos1;
                tpos2 = tpos1;
                f1 = far;
                spos1 = spos;
                tpos1 = tpos;
            } else if (far < f2) {
                f2 = far;
                spos2 = spos;
                tpos2 = tpos;
            }
        }
}

void voronoi_f1_2d(float ss, tt, jitter; output float f1, spos1, tpos1;)
{
    float f2 = 0, spos2 = 0, tpos2 = 0;
    voronoi_f1f2_2d(ss, tt, jitter, f1, spos1, tpos1, f2, spos2, tpos2);
}

#endif
