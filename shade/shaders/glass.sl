/* Clear glass with Fresnel reflection and refraction, traced, or looked up in texturename, an environment map, when
   there is one. eta is the index of refraction inside over that outside. blur spreads the rays, of which there are
   so many samples either way where the eye looks, over a cone: its half angle in radians. */
surface glass(
    float Ka = 0.2, Kd = 0, Ks = 0.5, Kr = 1, Kt = 1, roughness = 0.05, eta = 1.5;
    color specularcolor = 1, transmitcolor = 1;
    string texturename = "";
    float samples = 1, blur = 0;)
{
    normal Nn = normalize(N);
    normal Nf = faceforward(Nn, I);
    vector In = normalize(I);
    float reflected, transmitted;
    vector R, T;
    color seen;
    float rays = (raydepth() > 0) ? 1 : samples; /* else samples to the power of the depth */

    /* From the outside a ray goes from index 1 to index eta, from the inside back. */
    fresnel(In, Nf, (In . Nn < 0) ? 1 / eta : eta, reflected, transmitted, R, T);
    if (texturename != "" && texturename != "raytrace") {
        seen = Kr * reflected * color environment(texturename, vtransform("world", R)) +
               Kt * transmitted * transmitcolor * color environment(texturename, vtransform("world", T));
    } else {
        seen = Kr * reflected * trace(P, R, "samples", rays, "samplecone", blur);
        if (Kt * transmitted > 0)
            seen += Kt * transmitted * transmitcolor * trace(P, T, "samples", rays, "samplecone", blur);
    }
    Oi = Os;
    Ci = Os * (Cs * (Ka * ambient() + Kd * diffuse(Nf)) + seen +
               specularcolor * Ks * specular(Nf, -In, roughness));
}
