/* A lamp's lens: bright where one looks into the beam, with ribs, and glass at its rim. */
surface head_lamp(color beam = 30; float mirror = .08;)
{
    normal Nf = faceforward(normalize(N), I);
    vector In = normalize(I);
    point Q = transform("shader", P);
    float away = length(vector(xcomp(Q), ycomp(Q), 0));
    float core = pow(max(0, 1 - away * away), 5);
    float rib = .7 + .3 * cos(40 * xcomp(Q));
    Oi = 1;
    Ci = beam * (.035 * rib + core);
    if (raydepth() == 0) Ci += mirror * trace(P, reflect(In, Nf));
}
