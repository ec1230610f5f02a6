/* break and continue with and without counts, loops in loops. */
surface loops(uniform float n = 5)
{
    float i, j, sum = 0;
    for (i = 0, j = 0; i < n; i += 1) {
        if (mod(i, 2) == 0) continue;
        while (j < 10) {
            j += 1;
            if (j > s * 10) break;
            if (sum > 100) break 2;
            for (;;) {
                sum += noise(i, j);
                if (sum > 50) continue 2; else break;
            }
        }
    }
    for (uniform float k = 0; k < 3; k += 1) sum += k;
    while (sum > 1) sum /= 2;
    illuminance(P) { if (sum > .5) break; Ci += Cl; }
    Oi = 1; ;
}
