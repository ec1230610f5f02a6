/* Short names for layered patterns: masks and their combinations, tiles, and scattered values. */
#ifndef RMANNOTES_SL
#define RMANNOTES_SL 1

/* Masks from 0 to 1. */
#define blend(a, b, x) ((a) * (1 - (x)) + (b) * (x))
#define intersection(a, b) ((a) * (b))
#define union(a, b) ((a) + (b) - (a) * (b))
#define difference(a, b) ((a) * (1 - (b)))
#define complement(a) (1 - (a))
#define pulse(a, b, fuzz, x) (smoothstep((a) - (fuzz), (a), (x)) - smoothstep((b) - (fuzz), (b), (x)))

/* Tiles: where on the tile, and which. */
#define repeat(x, freq) (mod((x) * (freq), 1.0))
#define whichtile(x, freq) (floor((x) * (freq)))
#define odd(x) (mod((x), 2) == 1)
#define even(x) (mod((x), 2) == 0)

/* Noise from -1 to 1, and values spread over lo to hi. */
#define snoise(x) (noise(x) * 2 - 1)
#define snoise2(x, y) (noise(x, y) * 2 - 1)
#define udn(x, lo, hi) (smoothstep(0.25, 0.75, float noise(x)) * ((hi) - (lo)) + (lo))
#define udn2(x, y, lo, hi) (smoothstep(0.25, 0.75, float noise(x, y)) * ((hi) - (lo)) + (lo))

/* Turned about (ox, oy); and polar coordinates, angles from -PI to PI. */
#define rotate2d(x, y, rad, ox, oy, rx, ry)                                       \
    rx = ((x) - (ox)) * cos(rad) - ((y) - (oy)) * sin(rad) + (ox);                \
    ry = ((x) - (ox)) * sin(rad) + ((y) - (oy)) * cos(rad) + (oy)
#define topolar2d(x, y, r, theta)                                                 \
    r = sqrt((x) * (x) + (y) * (y));                                              \
    theta = atan(y, x)
#define fromPolar2d(r, theta, x, y)                                               \
    x = (r) * cos(theta);                                                         \
    y = (r) * sin(theta)

#endif
