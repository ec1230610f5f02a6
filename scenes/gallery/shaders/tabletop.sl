/* Dark polished stone: veins, light by diffuse(), and a reflection that is stronger towards grazing angles. */
surface tabletop(float Kd = .9, samples = 4, blur = .03;)
{
    normal Nf = faceforward(normalize(N), I);
    vector In = normalize(I);
    /* Veins: ridges of a sine that turbulence bends, no finer than what a pixel sees. */
    point Q = .55 * transform("world", P);
    float size = sqrt(area(Q)), bend = 0, scale = 1;
    while (scale < 20 && size * scale < .5) {
        bend += (noise(Q * scale) - .5) / scale;
        scale *= 2;
    }
    float vein = pow(1 - abs(sin(2.2 * xcomp(Q) + 1.3 * zcomp(Q) + 6 * bend)), 14);
    color stone = mix(color(.085, .09, .10), color(.7, .6, .42), .5 * vein);
    float kr, kt;
    fresnel(In, Nf, 1 / 1.5, kr, kt);
    Oi = 1;
    Ci = Kd * stone * diffuse(Nf) +
         kr * trace(P, reflect(In, Nf), "samples", (raydepth() > 0) ? 1 : samples, "samplecone", blur);
}
