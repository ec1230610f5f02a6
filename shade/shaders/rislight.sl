/* An area light, as path tracers have it: lightcolor times intensity is what each point of it sends out in each
   direction. Its shape is none of this shader's business: it is asked about one place of the shape after another, and
   told what the place stands for.

   P, N: the place, and the direction in which it shines. __solidangle: what it takes of the sky if there is no
   other. __radiance: its own colour. __area: that of the shape.

   normalized = 1: the power is divided by the area. focus: a power of the cosine about N. Beyond coneangle degrees
   from N there is none, softly by conesoftness of that. isdistant = 1: it is nowhere, and shines along N.
   traceshadows = 1: what rays meet on the way makes shadows, of shadowcolor. */
light rislight(
    float intensity = 1;
    color lightcolor = 1;
    float normalized = 0, focus = 0, coneangle = 90, conesoftness = 0;
    float isdistant = 0, traceshadows = 1;
    color shadowcolor = 0;
    varying float __solidangle = 0;
    varying color __radiance = 1;
    varying float __area = 1;)
{
    varying float power = intensity;
    varying float arriving = __solidangle / PI;

    if (normalized == 1)
        power /= max(__area, 0.000001);
    if (isdistant == 1) {
        solar(vector N, 0) {
            Cl = power * arriving * __radiance * lightcolor;
            if (traceshadows == 1 && arriving > 0)
                Cl *= mix(shadowcolor, color 1, transmission(Ps, Ps - 1e18 * vector N));
        }
    } else {
        illuminate(P, N, PI / 2) {
            float facing = clamp((L . N) / max(length(L), 1e-20), 0, 1);

            if (coneangle < 90)
                arriving *= 1 - smoothstep(radians(coneangle * (1 - conesoftness)), radians(coneangle) + 0.001,
                                           acos(facing));
            if (focus > 0)
                arriving *= pow(facing, focus);
            Cl = power * arriving * __radiance * lightcolor;
            if (traceshadows == 1 && arriving > 0)
                Cl *= mix(shadowcolor, color 1, transmission(Ps, P));
        }
    }
}
