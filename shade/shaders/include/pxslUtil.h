/* Filtered noises over a manifold (a point and its changes across a micropolygon), and blends. */
#ifndef PXSLUTIL_H
#define PXSLUTIL_H 1

#include "filterwidth.h"
#include "noises.h"
#include "patterns.h"

#define pxslLooseFilterWidth(dpu, dpv) max(length((dpu) + (dpv)), MINFILTWIDTH)
#define pxslTightFilterWidth(dpu, dpv) max(length((dpu) ^ (dpv)), MINFILTWIDTH)
#define pxslFilterWidth(dpu, dpv) pxslTightFilterWidth(dpu, dpv)

#define pxslFilteredFNoise(p, dpu, dpv) fadeout(float noise(p), 0.5, 1, pxslFilterWidth(dpu, dpv))
#define pxslFilteredCNoise(p, dpu, dpv) fadeout(color noise(p), color(0.5), 1, pxslFilterWidth(dpu, dpv))
#define pxslFilteredVNoise(p, dpu, dpv) filteredvsnoise(p, pxslFilterWidth(dpu, dpv))

/* Between four corners: c2 and c0 at x = 0, c3 and c1 at x = 1, y from 0 to 1. */
#define pxslBimix(c0, c1, c2, c3, x, y) mix(mix(c2, c0, y), mix(c3, c1, y), x)

#endif
