/* Metal that mirrors what rays see, in its colour, whiter towards its rim. */
surface polished_metal(float samples = 1, blur = 0;)
{
    normal Nf = faceforward(normalize(N), I);
    vector In = normalize(I);
    float rim = pow(1 - abs(In . Nf), 5);
    /* In mirrors of mirrors one ray does: else they would be samples to the power of the depth. */
    float rays = (raydepth() > 0) ? 1 : samples;
    Oi = Os;
    Ci = Oi * mix(Cs, color(1), rim) * trace(P, reflect(In, Nf), "samples", rays, "samplecone", blur);
}
