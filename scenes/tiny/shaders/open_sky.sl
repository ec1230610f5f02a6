/* What stands under a white sky and in a sun that casts hard shadows; checks by the square. */
surface open_sky(float checks = 0; point sun = point "world" (5, 6, -3)) {
    normal n = faceforward(normalize(N), I);
    float check = checks * mod(floor(2 * s + 1000) + floor(2 * t + 1000), 2);
    color lit = transmission(P, sun) * max(normalize(sun - P) . n, 0);
    Oi = Os;
    Ci = Oi * Cs * (1 - .5 * check) * (.35 * (1 - occlusion(P, n, 16)) + .8 * lit);
}
