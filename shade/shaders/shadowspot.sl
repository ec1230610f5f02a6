/* spotlight, with shadows of the depth map shadowname. A bias below zero leaves it to Option "shadow" "bias". */
light shadowspot(
    float intensity = 1;
    color lightcolor = 1;
    point from = point "shader" (0, 0, 0);
    point to = point "shader" (0, 0, 1);
    float coneangle = radians(30), conedeltaangle = radians(5), beamdistribution = 2;
    string shadowname = "";
    float samples = 16, width = 1, blur = 0, bias = -1;)
{
    uniform vector axis = normalize(to - from);
    uniform float cosoutside = cos(coneangle);
    uniform float cosinside = cos(coneangle - conedeltaangle);

    illuminate(from, axis, coneangle) {
        float cosangle = (L . axis) / length(L);
        float atten = pow(max(cosangle, 0), beamdistribution) / (L . L);
        atten *= smoothstep(cosoutside, cosinside, cosangle);
        Cl = atten * intensity * lightcolor;
        if (shadowname != "")
            Cl *= 1 - color shadow(shadowname, Ps, "samples", samples, "width", width, "blur", blur, "bias", bias);
    }
}
