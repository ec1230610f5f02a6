/* Variables that the table leaves out for a kind of shader, and that shaders of the kind use. */
light borrowed_light(float samples = 16; string map = "";) {
    vector facing = faceforward(normalize(N), I);
    float hidden = occlusion(map, Ps, Ns, 0.1, "samples", samples);
    Cl = (1 - hidden) * indirectdiffuse(P, facing, samples);
    L = 0;
}

volume borrowed(float density = 0.1; string map = "cloud.ptc";) {
    float coming = 1, leaving = 1;
    incident("density", coming);
    opposite("density", leaving);
    bake3d(map, "", P, normalize(N), "_radiosity", Ci, "interpolate", 1);
    Ci = mix(Ci, Cs, 1 - exp(-density * (coming + leaving) * length(I)));
}
