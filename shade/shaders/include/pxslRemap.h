/* Curves from 0..1 to 0..1 [Perlin89]: 0.5 leaves the value as it is. */
#ifndef PXSLREMAP_H
#define PXSLREMAP_H 1

#define pxslBiasF(x, b) pow(clamp(x, 0, 1), log(b) / log(0.5))
#define pxslContrastF(x, c) pxslGainF(x, c)

float pxslGainF(float x, g)
{
    float value = 0;
    if (x < 0.5)
        value = 0.5 * pxslBiasF(2 * x, 1 - g);
    else
        value = 1 - 0.5 * pxslBiasF(2 - 2 * x, 1 - g);
    return value;
}

#endif
