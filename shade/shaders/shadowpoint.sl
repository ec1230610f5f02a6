/* pointlight, with shadows of six depth maps, each seen from the light along an axis of the light's space:
   sfpx along +x, sfnx along -x, and so on. Directions whose map is not named are not shadowed. A bias below
   zero leaves it to Option "shadow" "bias". */
light shadowpoint(
    float intensity = 1;
    color lightcolor = 1;
    point from = point "shader" (0, 0, 0);
    string sfpx = "", sfnx = "", sfpy = "", sfny = "", sfpz = "", sfnz = "";
    float samples = 16, width = 1, blur = 0, bias = -1;)
{
    illuminate(from) {
        vector D = vtransform("shader", L);
        float ax = abs(xcomp(D)), ay = abs(ycomp(D)), az = abs(zcomp(D));
        color hidden = 0;

        if (ax >= ay && ax >= az) {
            if (xcomp(D) >= 0) {
                if (sfpx != "")
                    hidden = color shadow(sfpx, Ps, "samples", samples, "width", width, "blur", blur, "bias", bias);
            } else if (sfnx != "") {
                hidden = color shadow(sfnx, Ps, "samples", samples, "width", width, "blur", blur, "bias", bias);
            }
        } else if (ay >= az) {
            if (ycomp(D) >= 0) {
                if (sfpy != "")
                    hidden = color shadow(sfpy, Ps, "samples", samples, "width", width, "blur", blur, "bias", bias);
            } else if (sfny != "") {
                hidden = color shadow(sfny, Ps, "samples", samples, "width", width, "blur", blur, "bias", bias);
            }
        } else {
            if (zcomp(D) >= 0) {
                if (sfpz != "")
                    hidden = color shadow(sfpz, Ps, "samples", samples, "width", width, "blur", blur, "bias", bias);
            } else if (sfnz != "") {
                hidden = color shadow(sfnz, Ps, "samples", samples, "width", width, "blur", blur, "bias", bias);
            }
        }
        Cl = (1 - hidden) * intensity * lightcolor / (L . L);
    }
}
