/* Shines in place of a light whose shader is not found: all around from a point or, with spot = 1, in a cone about
   to - from. falloff is the power of the distance that it fades with; shadowname is a depth map. */
light standinlight(
    float intensity = 1;
    color lightcolor = 1;
    point from = point "shader" (0, 0, 0);
    point to = point "shader" (0, 0, 1);
    float spot = 0, falloff = 0;
    float coneangle = radians(30), conedeltaangle = radians(5), beamdistribution = 0;
    string shadowname = "";)
{
    uniform vector axis = normalize(to - from);
    uniform float angle = (spot == 1) ? coneangle : PI;
    uniform float cosoutside = cos(coneangle);
    uniform float cosinside = cos(coneangle - conedeltaangle);

    illuminate(from, axis, angle) {
        float atten = pow(length(L), -falloff);
        if (spot == 1) {
            float cosangle = (L . axis) / length(L);
            atten *= pow(max(cosangle, 0), beamdistribution) * smoothstep(cosoutside, cosinside, cosangle);
        }
        Cl = atten * intensity * lightcolor;
        if (shadowname != "")
            Cl *= 1 - color shadow(shadowname, Ps);
    }
}
