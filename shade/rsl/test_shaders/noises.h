/* Helpers that several shaders include. */
#ifndef NOISES_H
#define NOISES_H

#define snoise(x) (2 * (float noise(x)) - 1)
#define vsnoise(p) (2 * (vector noise(p)) - 1)
#define MINFILTWIDTH 1.0e-6
#define filterwidth(x) max(abs(Du(x) * du) + abs(Dv(x) * dv), MINFILTWIDTH)
#define filterwidthp(p) max(sqrt(area(p)), MINFILTWIDTH)
#define filteredsnoise(p, width) (snoise(p) * (1 - smoothstep(0.2, 0.75, width)))

/* Sum of octaves, each faded where it is finer than the filter. */
float fBm(point p; float filtwidth; uniform float maxoctaves, lacunarity, gain) {
    uniform float i;
    uniform float amp = 1;
    varying point pp = p;
    varying float sum = 0, fw = filtwidth;

    for (i = 0; i < maxoctaves && fw < 1.0; i += 1) {
        sum += amp * filteredsnoise(pp, fw);
        amp *= gain;
        pp *= lacunarity;
        fw *= lacunarity;
    }
    return sum;
}

void voronoi(point P; float jitter; output float f1; output point pos1;) {
    point thiscell = point(floor(xcomp(P)) + 0.5, floor(ycomp(P)) + 0.5, floor(zcomp(P)) + 0.5);
    f1 = 1000;
    uniform float i, j, k;
    for (i = -1; i <= 1; i += 1) {
        for (j = -1; j <= 1; j += 1) {
            for (k = -1; k <= 1; k += 1) {
                point testcell = thiscell + vector(i, j, k);
                point pos = testcell + jitter * (vector cellnoise(testcell) - 0.5);
                vector offset = pos - P;
                float dist = offset.offset;
                if (dist < f1) {
                    f1 = dist;
                    pos1 = pos;
                }
            }
        }
    }
    f1 = sqrt(f1);
}
#endif
