/* A polished floor of marble tiles: veins, and a mirror that is the stronger the flatter one looks. */
surface polished_marble(
    float Ka = 1, Kd = .62, Kr = .9, tile = 1.6;
    color light = color(.74, .71, .66), dark = color(.13, .14, .16);)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = normalize(I);
    point Q = transform("world", P);
    float x = xcomp(Q) / tile, z = zcomp(Q) / tile;
    float parity = mod(floor(x) + floor(z), 2);
    float pixel = max(1e-4, sqrt(area(P)));
    float amount = 0, freq = 1.1;
    uniform float octave;
    point M = Q + parity * vector(7, 3, 5);
    for (octave = 0; octave < 6; octave += 1) {
        amount += (1 - smoothstep(.25, .75, pixel * freq)) * abs(2 * noise(M * freq) - 1) / freq;
        freq *= 2;
    }
    float vein = pow(.5 + .5 * sin(2.6 * xcomp(M) + 1.3 * zcomp(M) + 7 * amount), 9);
    color stone = parity < .5 ? mix(light, light * .62, vein) : mix(dark, dark * 2.6, vein);
    /* Schlick 1994, from .05 for polished stone. */
    float mirror = Kr * (.05 + .95 * pow(1 - min(1, abs(V . Nf)), 5)) + .12;
    color seen = trace(P, reflect(V, Nf));
    float far = smoothstep(9, 30, length(I));
    Oi = Os;
    Ci = Oi * mix(stone * (Ka * ambient() + Kd * diffuse(Nf)) + mirror * seen, color(.02, .022, .028), far);
}
