/* Patterns along one dimension and tilings, with versions averaged over a filter of width dx. */
#ifndef PATTERNS_H
#define PATTERNS_H 1

#include "filterwidth.h"

#define boxstep(a, b, x) (clamp(((x) - (a)) / ((b) - (a)), 0, 1))

float sqr(float x)
{
    return x * x;
}

float filteredabs(float x, dx)
{
    float low = x - dx / 2, high = x + dx / 2;
    return (high * abs(high) - low * abs(low)) / (2 * dx);
}

/* The integral of smoothstep(0, 1, x) from minus infinity. */
float smoothstepintegral(float x)
{
    float inner = clamp(x, 0, 1);
    return inner * inner * inner * (1 - inner / 2) + max(x - 1, 0);
}

float filteredsmoothstep(float e0, e1, x, dx)
{
    float size = e1 - e0, at = (x - e0) / size, width = dx / size;
    return (smoothstepintegral(at + width / 2) - smoothstepintegral(at - width / 2)) / width;
}

/* 1 between the edges. */
float pulse(float edge0, edge1, x)
{
    return step(edge0, x) - step(edge1, x);
}

float filteredpulse(float edge0, edge1, x, dx)
{
    float high = min(x + dx / 2, edge1), low = max(x - dx / 2, edge0);
    return max(high - low, 0) / dx;
}

/* 1 from edge to the end of each period. */
float pulsetrain(float edge, period, x)
{
    return step(edge, mod(x, period));
}

/* The integral of a pulse train of period 1 from 0. */
float pulsetrainintegral(float edge, x)
{
    float whole = floor(x);
    return whole * (1 - edge) + max(x - whole - edge, 0);
}

float filteredpulsetrain(float edge, period, x, dx)
{
    float begins = edge / period, at = x / period, width = dx / period;
    return (pulsetrainintegral(begins, at + width / 2) - pulsetrainintegral(begins, at - width / 2)) / width;
}

/* Rises from e0 to e1, falls from e2 to e3. */
float smoothpulse(float e0, e1, e2, e3, x)
{
    return smoothstep(e0, e1, x) - smoothstep(e2, e3, x);
}

float filteredsmoothpulse(float e0, e1, e2, e3, x, dx)
{
    return filteredsmoothstep(e0, e1, x, dx) - filteredsmoothstep(e2, e3, x, dx);
}

float smoothpulsetrain(float e0, e1, e2, e3, period, x)
{
    return smoothpulse(e0, e1, e2, e3, mod(x, period));
}

/* The colour with hue, saturation and lightness varied by the index. */
color varyEach(color Cin; float index, varyhue, varysat, varylum;)
{
    color hsl = ctransform("hsl", Cin);
    float hue = mod(comp(hsl, 0) + varyhue * (float cellnoise(index + 3) - 0.5), 1);
    float saturation = comp(hsl, 1) * (1 - varysat * (float cellnoise(index - 14) - 0.5));
    float lightness = comp(hsl, 2) * (1 - varylum * (float cellnoise(index + 37) - 0.5));
    return ctransform("hsl", "rgb", color(hue, clamp(saturation, 0, 1), clamp(lightness, 0, 1)));
}

/* Square tiles of size 1: 1 on a tile, 0 in the grooves; which tile, and where on it. */
float tilepattern(float ss, tt, ds, dt, groovewidth, grooveheight; output float swhichtile, twhichtile, stile, ttile;)
{
    swhichtile = floor(ss);
    twhichtile = floor(tt);
    stile = ss - swhichtile;
    ttile = tt - twhichtile;
    return filteredpulsetrain(groovewidth, 1, ss + groovewidth / 2, ds) *
           filteredpulsetrain(grooveheight, 1, tt + grooveheight / 2, dt);
}

/* Rows of bricks, each row staggered against the one below: which brick, and where on it (0 to 1). */
void basicbrick(float x, y; uniform float tilewidth, tileheight, rowstagger, rowstaggervary, jaggedfreq, jaggedamp;
                output float column, row, xtile, ytile;)
{
    float across = x, up = y;

    if (jaggedamp != 0) {
        point jag = point noise(x * jaggedfreq / tilewidth, y * jaggedfreq / tileheight);
        across += jaggedamp * xcomp(jag);
        up += jaggedamp * ycomp(jag);
    }
    across /= tilewidth;
    up /= tileheight;
    row = floor(up);
    across += mod(rowstagger * row, 1) + rowstaggervary * (float noise(row + 0.5) - 0.5);
    column = floor(across);
    xtile = across - column;
    ytile = up - row;
}

#endif
