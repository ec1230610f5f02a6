/* The preprocessor, hard at work. */
#define VERSION 3
#define STR(x) #x
#define XSTR(x) STR(x)
#define CAT(a, b) a ## b
#define XCAT(a, b) CAT(a, b)
#define SQR(x) ((x) * (x))
#define LERP(a, b, f) \
    ((1 - (f)) * (a) \
     + (f) * (b))
#define PARAM(type, name, ...) type CAT(p_, name) = __VA_ARGS__
#define EMPTY
#define LOOP(n) uniform float n; for (n = 0; n < 3; n += 1)
#if VERSION >= 3 && defined(SQR) && !defined NOTHING
#   define KIND surface
#elif VERSION == 2
#   error old
#else
#   define KIND broken
#endif
#ifdef NOTHING
this is " not read' at all
#endif
#ifndef TRAPEZE
#error TRAPEZE is not defined
#endif
#pragma annotation Ka "gadgettype=floatslider"
KIND XCAT(mac, ros)(PARAM(float, Ka, 1); PARAM(color, tint, color(1, 1, SQR(.5))) EMPTY)
{
    string v = XSTR(VERSION);  // "3"
    LOOP(i) { Ci += LERP(0, p_tint, SQR(i)); }
    #undef SQR
    float SQR = p_Ka * __LINE__;
    Oi = SQR; /* a comment
    of several lines */ if (v == "3" /* here too */ && __FILE__ != "") Ci *= SQR;
}
