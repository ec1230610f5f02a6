/* A road in a tunnel: t goes over `metres` of it from `begin` on, s over its breadth. Asphalt with marks, a little
   wet, under lamps in rows; occlusion() holds their light off beneath cars. */
surface asphalt(float metres = 100, begin = 0, wide = 8, spacing = 5, around = 32, samples = 32, blur = .05;
                color light = color(1.35, .92, .50);)
{
    normal Nf = faceforward(normalize(N), I);
    vector In = normalize(I);
    float along = begin + metres * t, across = wide * s;
    float first = 1 - min(1, raydepth());
    point Q = point(across, 0, along);
    float grain = .5 + .5 * noise(40 * Q) * (1 - smoothstep(4, 14, length(I)));
    float worn = noise(point(.9 * across, 0, .07 * along));
    color stone = color(.060, .059, .060) * (.6 + .8 * grain) * (.75 + .5 * worn);
    float edge = 1 - smoothstep(.06, .08, min(abs(across - .35), abs(across - wide + .35)));
    float dash = 1 - smoothstep(.06, .08, abs(across - wide / 2));
    dash *= 1 - smoothstep(.5, .51, abs(mod(along / 6, 1) - .5) * 2);
    stone = mix(stone, color(.60, .58, .54), max(edge, dash) * (.7 + .3 * grain));
    float pool = 1 + .25 * cos(2 * PI * (along - 1.2) / spacing);
    float hidden = 0, kr, kt;
    color seen = 0;
    if (first > 0) hidden = occlusion(P, Nf, around, "maxdist", 3);
    fresnel(In, Nf, 1 / 1.33, kr, kt);
    kr *= .75 * (.55 + .45 * worn);
    if (first > 0 && kr > .004) seen = trace(P, reflect(In, Nf), "samples", samples, "samplecone", blur);
    seen = min(seen, color(6));
    Oi = 1;
    /* Lamps are above, where what stands on the road hides more than of the rest. */
    Ci = stone * light * pool * pow(1 - hidden, 2) + kr * seen;
}
