/* Dark polished stone: veins, light by diffuse(), and a reflection that is stronger towards grazing angles. */
surface tabletop(float Kd = .9, samples = 4, blur = .03;)
{
    normal Nf = faceforward(normalize(N), I);
    vector In = normalize(I);
    point Q = 1.3 * transform("world", P);
    float size = sqrt(area(Q)), sum = 0, amplitude = 1, scale = 1;
    while (amplitude > .1) {
        if (size * scale < .5)
            sum += amplitude * abs(.5 - noise(Q * scale));
        amplitude *= .5;
        scale *= 2;
    }
    float vein = 1 - smoothstep(.02, .16, abs(sum - .42));
    color stone = mix(color(.018, .02, .024), color(.32, .27, .2), vein * .55);
    float kr, kt;
    fresnel(In, Nf, 1 / 1.5, kr, kt);
    Oi = 1;
    Ci = Kd * stone * diffuse(Nf) + kr * trace(P, reflect(In, Nf), "samples", samples, "samplecone", blur);
}
