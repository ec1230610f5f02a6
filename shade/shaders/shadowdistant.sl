/* distantlight, with shadows of the depth map shadowname. A bias below zero leaves it to Option "shadow" "bias". */
light shadowdistant(
    float intensity = 1;
    color lightcolor = 1;
    point from = point "shader" (0, 0, 0);
    point to = point "shader" (0, 0, 1);
    string shadowname = "";
    float samples = 16, width = 1, blur = 0, bias = -1;)
{
    solar(to - from, 0) {
        Cl = intensity * lightcolor;
        if (shadowname != "")
            Cl *= 1 - color shadow(shadowname, Ps, "samples", samples, "width", width, "blur", blur, "bias", bias);
    }
}
