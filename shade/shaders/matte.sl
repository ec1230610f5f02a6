/* RISpec 3.2, A.1.2: diffuse reflection. */
surface matte(float Ka = 1, Kd = 1;)
{
    normal Nf = faceforward(normalize(N), I);

    Oi = Os;
    Ci = Os * Cs * (Ka * ambient() + Kd * diffuse(Nf));
}
