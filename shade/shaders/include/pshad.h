/* The space in which a shader computes its pattern: parameters shadingspace and shadingfreq and, where USE_PREF is defined as
   non-zero, a reference position that the primitive may give. */
#ifndef PSHAD_H
#define PSHAD_H 1

#include "filterwidth.h"

#ifndef USE_PREF
#define USE_PREF 0
#endif

/* GET_PSHAD declares Pshad, the position there, and dPshad, the width of a filter about it. */
#if USE_PREF
#define PSHAD_PARAMS(space, freq) \
    uniform string shadingspace = space; uniform float shadingfreq = freq; varying point Pref = point(-1.0e10, -1.0e10, -1.0e10)
#define GET_PSHAD                                        \
    point Pshad = P;                                     \
    if (xcomp(Pref) > -1.0e9) Pshad = Pref;              \
    Pshad = shadingfreq * transform(shadingspace, Pshad); \
    float dPshad = filterwidthp(Pshad)
#else
#define PSHAD_PARAMS(space, freq) uniform string shadingspace = space; uniform float shadingfreq = freq
#define GET_PSHAD                                          \
    point Pshad = shadingfreq * transform(shadingspace, P); \
    float dPshad = filterwidthp(Pshad)
#endif

#define DEFAULT_PSHAD_PARAMS PSHAD_PARAMS("shader", 1)

#endif
