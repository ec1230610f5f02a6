/* A mirror with a shade of its own. */
surface mirrored(float Kr = .8) {
    Oi = 1;
    Ci = (1 - Kr) * Cs + Kr * color trace(P, reflect(normalize(I), faceforward(normalize(N), I)));
}
