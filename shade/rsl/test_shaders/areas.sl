/* A light with area, shadows and a category, from one kind of statement each. */
light areas(float intensity = 1; color lightcolor = 1; point from = point "shader" (0, 0, 0), to = point "shader" (0, 0, 1);
            float coneangle = radians(30), conedelta = radians(5), beamdistribution = 2;
            string shadowname = ""; float kind = 0; output float __nonspecular = 0; string __category = "key")
{
    uniform vector A = (to - from) / length(to - from);
    uniform float cosoutside = cos(coneangle), cosinside = cos(coneangle - conedelta);
    if (kind == 0) {
        illuminate(from, A, coneangle) {
            float cosangle = L . A / length(L);
            float atten = pow(cosangle, beamdistribution) / (L . L);
            atten *= smoothstep(cosoutside, cosinside, cosangle);
            if (shadowname != "") atten *= 1 - float shadow(shadowname, Ps);
            Cl = atten * intensity * lightcolor;
        }
    } else if (kind == 1) {
        solar(A, 0) Cl = intensity * lightcolor;
    } else if (kind == 2)
        illuminate(from) Cl = intensity * lightcolor / (L . L);
    else
        solar() { Cl = intensity * environment("sky.tx", L); }
}
