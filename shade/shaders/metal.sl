/* RISpec 3.2, A.1.3: a rough metal, whose highlights have its own colour. It also reflects what rays see, as much of
   it as Kr says: so many samples in a cone whose half angle is blur, in radians. */
surface metal(float Ka = 1, Ks = 1, roughness = 0.1, Kr = 0, samples = 1, blur = 0;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    color reflection = 0;
    float rays = (raydepth() > 0) ? 1 : samples; /* else samples to the power of the depth */

    if (Kr > 0)
        reflection = Kr * color trace(P, reflect(-V, Nf), "samples", rays, "samplecone", blur);
    Oi = Os;
    Ci = Os * Cs * (Ka * ambient() + Ks * specular(Nf, V, roughness) + reflection);
}
