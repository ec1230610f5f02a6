/* Solid wood: a trunk along the z axis of shader space, ringscale rings to the unit, with grain along it. */
surface wood(
    float ringscale = 10, grainscale = 60, txtscale = 1, wobble = 0.38;
    color lightwood = color (0.55, 0.29, 0.11), darkwood = color (0.22, 0.085, 0.025);
    float Ka = 0.2, Kd = 0.7, Ks = 0.25, roughness = 0.12;
    color specularcolor = 1;
    output varying color albedo = 0;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    point Q = transform("shader", P) * txtscale;
    vector bend;
    float x, y, radius, ring, grain, amount;
    color Ct;

    /* The trunk is not round, and leans: low noise moves the rings. */
    bend = wobble * ((2 * vector noise(Q * 0.8) - vector (1, 1, 1)) + 0.15 * vector noise(Q * 4));
    x = xcomp(Q) + xcomp(bend);
    y = ycomp(Q) + ycomp(bend);
    radius = ringscale * sqrt(x * x + y * y);

    /* Each ring grows light slowly and ends dark at once; some years are darker than others. */
    ring = mod(radius, 1);
    amount = smoothstep(0, 0.75, ring) * (1 - smoothstep(0.88, 1, ring));
    amount *= 0.65 + 0.35 * cellnoise(floor(radius));

    /* Pores: noise drawn out along the trunk. */
    grain = noise(point (xcomp(Q) * grainscale, ycomp(Q) * grainscale, zcomp(Q) * grainscale * 0.06));
    amount = amount * 0.8 + 0.25 * smoothstep(0.533, 0.7, grain);

    Ct = Cs * mix(lightwood, darkwood, clamp(amount, 0, 1));
    albedo = Os * Ct;
    Oi = Os;
    Ci = Os * (Ct * (Ka * ambient() + Kd * diffuse(Nf)) +
               specularcolor * Ks * (1 - 0.5 * amount) * specular(Nf, V, roughness));
}
