/* RISpec 3.2, A.2.4: a point light with a cone, soft between coneangle - conedeltaangle and coneangle. */
light spotlight(
    float intensity = 1;
    color lightcolor = 1;
    point from = point "shader" (0, 0, 0);
    point to = point "shader" (0, 0, 1);
    float coneangle = radians(30), conedeltaangle = radians(5), beamdistribution = 2;)
{
    uniform vector axis = normalize(to - from);
    uniform float cosoutside = cos(coneangle);
    uniform float cosinside = cos(coneangle - conedeltaangle);

    illuminate(from, axis, coneangle) {
        float cosangle = (L . axis) / length(L);
        float atten = pow(max(cosangle, 0), beamdistribution) / (L . L);
        atten *= smoothstep(cosoutside, cosinside, cosangle);
        Cl = atten * intensity * lightcolor;
    }
}
