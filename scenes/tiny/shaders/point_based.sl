/* What discs of a cloud send and hide; without a file, those of the scene. */
surface point_based(string file = "";) {
    normal Nn = faceforward(normalize(N), I);
    float hidden = occlusion(P, Nn, 0, "pointbased", 1, "filename", file);
    color sent = indirectdiffuse(P, Nn, 0, "pointbased", 1, "filename", file, "hitsides", "front");
    Ci = Cs * (.7 * (1 - hidden) + sent);
    Oi = 1;
}
