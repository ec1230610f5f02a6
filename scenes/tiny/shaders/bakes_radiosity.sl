/* Bakes what the surface sends where light falls on it. */
surface bakes_radiosity(string file = "point_based.ptc";) {
    normal Nn = faceforward(normalize(N), I);
    color sent = Cs * diffuse(Nn);
    bake3d(file, "_radiosity", P, Nn, "interpolate", 1, "_radiosity", sent);
    Ci = sent;
    Oi = 1;
}
