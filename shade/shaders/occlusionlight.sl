/* Light from all around, traced: what of the sky a point sees, all of it alike or as the environment map envname
   shows it, whose z is that of envspace. It counts as ambient light. What is farther than maxdist hides nothing;
   coneangle is the half angle, in radians, of the part of the sky that shines. */
light occlusionlight(
    float intensity = 1;
    color lightcolor = 1;
    string envname = "", envspace = "world", subset = "";
    float samples = 64, maxdist = 1e30, coneangle = PI / 2, bias = -1;)
{
    vector In = Ps - E;
    normal Nf;
    color seen = 0;
    float hidden;

    surface("I", In);
    Nf = faceforward(normalize(Ns), In);
    hidden = occlusion(Ps, Nf, samples, "maxdist", maxdist, "coneangle", coneangle, "bias", bias, "subset", subset,
                       "environmentmap", envname, "environmentspace", envspace, "environmentcolor", seen);
    if (envname == "")
        seen = 1 - hidden;
    Cl = intensity * lightcolor * seen;
}
