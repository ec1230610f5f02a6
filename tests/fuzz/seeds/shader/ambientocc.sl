light ambientocc(float intensity = 1, samples = 64; string envmap = ""; color filter = color(1))
{
    normal Nn = normalize(N);
    Cl = intensity * filter * (1 - occlusion(Ps, Nn, samples));
    if (envmap != "") Cl *= environment(envmap, Nn, "blur", .5);
    L = (0, 0, 0);
}
