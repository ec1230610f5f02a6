/* A mirror of colour Cs, traced, or looked up in texturename, an environment map, when there is one. blur spreads
   the rays, of which there are so many samples, over a cone: its half angle in radians. */
surface mirror(
    float Ka = 0, Kd = 0, Ks = 1, Kr = 1, roughness = 0.05;
    color specularcolor = 1;
    string texturename = "";
    float samples = 1, blur = 0;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    vector R = reflect(-V, Nf);
    color seen;
    float rays = (raydepth() > 0) ? 1 : samples; /* else samples to the power of the depth */

    if (texturename != "" && texturename != "raytrace")
        seen = color environment(texturename, vtransform("world", R));
    else
        seen = trace(P, R, "samples", rays, "samplecone", blur);
    Oi = Os;
    Ci = Os * (Cs * (Ka * ambient() + Kd * diffuse(Nf) + Kr * seen) +
               specularcolor * Ks * specular(Nf, V, roughness));
}
