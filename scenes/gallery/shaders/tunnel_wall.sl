/* A tunnel's wall under rows of lamps: t goes over `metres` along it from `begin` on, s from `low` to `high` above
   the road. Glazed tiles with a coloured band, or plain concrete; the vault is lit from below. */
surface tunnel_wall(float metres = 100, begin = 0, low = 0, high = 2.5, tiled = 1, vault = 0, spacing = 5,
                          samples = 2;
                    color light = color(.85, .58, .31), band = color(.02, .16, .24);)
{
    normal Nf = faceforward(normalize(N), I);
    vector In = normalize(I);
    float along = begin + metres * t, up = mix(low, high, s);
    float first = 1 - min(1, raydepth());
    color stone = color(.42, .40, .37) * (.8 + .4 * noise(point(along * .5, up, 0)));
    float lit = .8 + .2 * cos(2 * PI * (along - 1.2) / spacing), kr = 0, kt;
    if (tiled > 0) {
        float joint = max(smoothstep(.475, .49, abs(mod(along / .6, 1) - .5)),
                          smoothstep(.46, .49, abs(mod(up / .3, 1) - .5)));
        stone = mix(color(.62, .60, .55), band, smoothstep(.89, .9, up) * (1 - smoothstep(1.19, 1.2, up)));
        stone *= .9 + .2 * cellnoise(point(floor(along / .6), floor(up / .3), 1));
        stone = mix(stone, color(.16, .15, .14), joint * .8);
        lit *= .55 + .45 * smoothstep(.2, 2, up);
        fresnel(In, Nf, 1 / 1.45, kr, kt);
    }
    if (vault > 0) lit = .11 + .10 * pow(abs(2 * s - 1), 3) * lit + .55 * lit * smoothstep(.30, .5, abs(s - .5));
    color seen = 0;
    if (first > 0 && kr > .004) seen = trace(P, reflect(In, Nf), "samples", samples, "samplecone", .03);
    Oi = 1;
    Ci = (1 - kr) * stone * light * lit + kr * seen;
}
