/* Writes how the surface is lit, and how high it lies, to a point cloud. */
surface bakes(string file = "bake3d.ptc"; float interpolate = 1;) {
    normal Nn = normalize(N);
    color lit = Cs * diffuse(faceforward(Nn, I));
    float height = ycomp(transform("world", P));
    bake3d(file, "_height,_radiosity", P, Nn, "interpolate", interpolate, "_height", height, "_radiosity", lit);
    Ci = lit;
    Oi = Os;
}
