displacement ocean(uniform float waves = 8; float height = .02, speed = 1; uniform vector wind = vector "world" (1, 0, 0))
{
    float h = 0; uniform float i;
    vector W = normalize(wind);
    for (i = 1; i <= waves; i += 1) {
        vector dir = normalize(W + .5 * (vector cellnoise(i) - (.5, .5, .5)));
        float phase = dir . vector(P) * i * 4 + time * speed * sqrt(i);
        h += sin(phase) / i;
    }
    vector Ndiff = normalize(N) - normalize(Ng);
    P += normalize(N) * h * height;
    N = normalize(calculatenormal(P)) + Ndiff;
}
