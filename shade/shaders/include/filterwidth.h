/* How far apart the shaded points lie, in a varying float or point. */
#ifndef FILTERWIDTH_H
#define FILTERWIDTH_H 1

#define MINFILTWIDTH 1.0e-6
#define filterwidth(x) max(abs(Du(x) * du) + abs(Dv(x) * dv), MINFILTWIDTH)
#define filterwidthp(p) max(sqrt(area(p)), MINFILTWIDTH)

/* A pattern's value, going over into its average where the filter is as wide as a feature. */
#define fadeout(value, average, featuresize, width) mix((value), (average), smoothstep(0.2, 0.6, (width) / (featuresize)))

#endif
