/* What is seen from afar of surfaces that path tracers' shaders describe: their colour, or texture, lit; highlights
   of specularcolor; what they send out themselves. What other surfaces would throw back at them is taken to be a
   part, bounce, of all the light that comes by. */
surface rissurface(
    color specularcolor = 0, emission = 0;
    float roughness = 0.8, opacity = 1, bounce = 0.15;
    string texturename = "", colorspace = "";
    float scales = 1, scalet = 1;
    output varying color albedo = 0;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    color base = Cs, passing = 0;
    float isthere = 0, channels = 3;
    string wrap = "periodic";

    if (texturename != "") {
        textureinfo(texturename, "exists", isthere);
        textureinfo(texturename, "channels", channels);
        /* Pictures that do not say what is outside of them repeat; those of one channel are grey. */
        if (textureinfo(texturename, "wrapmodes", wrap) == 1)
            wrap = "default";
        if (channels < 3)
            base *= float texture(texturename, s * scales, 1 - t * scalet, "wrap", wrap, "colorspace", colorspace);
        else
            base *= color texture(texturename, s * scales, 1 - t * scalet, "wrap", wrap, "colorspace", colorspace);
        if (isthere == 0)
            base *= 0.5;
    }
    illuminance(P)
        passing += Cl;
    albedo = Os * opacity * base;
    Oi = Os * opacity;
    Ci = Os * (opacity * base * (ambient() + diffuse(Nf) + bounce * passing) +
               specularcolor * specular(Nf, V, roughness) + emission);
}
