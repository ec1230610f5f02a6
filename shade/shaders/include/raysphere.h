/* Where a ray meets the sphere of radius r about the origin. */
#ifndef RAYSPHERE_H
#define RAYSPHERE_H 1

/* The number of hits farther along than eps; t0 and t1 are their distances. I has length 1. */
float raysphere(point E; vector I; float r, eps; output float t0, t1;)
{
    vector from = E - point(0, 0, 0);
    float middle = -(from . I);
    float half2 = middle * middle + r * r - from . from;
    float hits = 0;

    if (half2 >= 0) {
        float half = sqrt(half2);
        t0 = middle - half;
        t1 = middle + half;
        if (t0 > eps) {
            hits = (half2 > 0) ? 2 : 1;
        } else if (t1 > eps) {
            t0 = t1;
            hits = 1;
        }
    }
    return hits;
}

#endif
