/* RISpec 3.2, A.1.4: metal that also reflects an environment map, looked up along world-space directions; or what
   rays see, where the map is "raytrace": so many samples in a cone whose half angle is blur, in radians. Without a
   map it is metal. */
surface shinymetal(
    float Ka = 1, Ks = 1, Kr = 1, roughness = 0.1;
    string texturename = "";
    float samples = 1, blur = 0;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    color reflection = 0;
    float rays = (raydepth() > 0) ? 1 : samples; /* else samples to the power of the depth */

    if (texturename == "raytrace") {
        reflection = Kr * color trace(P, reflect(-V, Nf), "samples", rays, "samplecone", blur);
    } else if (texturename != "") {
        vector D = vtransform("world", reflect(-V, Nf));
        reflection = Kr * color environment(texturename, D);
    }
    Oi = Os;
    Ci = Os * Cs * (Ka * ambient() + Ks * specular(Nf, V, roughness) + reflection);
}
