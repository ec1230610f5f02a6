/* Light gathered from around: a diffuse part over the hemisphere, with a grey sky where nothing is hit, and a glossy
   part over a narrow cone, where surfaces tell their own colour, without their lighting. */
surface gathered(float gloss = 0, samples = 8;)
{
    normal Nf = faceforward(normalize(N), I);
    color around = 0, shine = 0, hit = 0;

    gather("illuminance", P, Nf, PI / 2, samples, "distribution", "cosine", "surface:Ci", hit) {
        around += hit / samples;
    } else {
        around += .6 / samples;
    }
    if (gloss > 0) {
        gather("environment", P, reflect(normalize(I), Nf), .15, samples, "primitive:Cs", hit) {
            shine += hit / samples;
        } else {
            shine += .3 / samples;
        }
    }
    Oi = Os;
    Ci = Os * (Cs * around * (1 - gloss) + shine * gloss);
}
