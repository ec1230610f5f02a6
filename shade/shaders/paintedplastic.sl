/* RISpec 3.2, A.1.6: plastic whose colour is multiplied by a texture over s and t. */
surface paintedplastic(
    float Ka = 1, Kd = 0.5, Ks = 0.5, roughness = 0.1;
    color specularcolor = 1;
    string texturename = "";
    output varying color albedo = 0;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    color Ct = Cs;

    if (texturename != "")
        Ct *= color texture(texturename, s, t);
    albedo = Os * Ct;
    Oi = Os;
    Ci = Os * (Ct * (Ka * ambient() + Kd * diffuse(Nf)) + specularcolor * Ks * specular(Nf, V, roughness));
}
