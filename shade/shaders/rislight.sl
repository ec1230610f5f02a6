/* A light of a shape, as path tracers have it: lightcolor times intensity is what each point of it sends out in
   each direction. All of it comes from the middle, without shadows, and is bounded near by.

   shape "rect" is a square and "disk" a circle of width 1 in the plane z = 0 of the light's space, which shine
   along +z, with twosided = 1 along -z too; "sphere" has the diameter 1. normalized = 1: the power is divided by
   the area. focus: a power of the cosine about z. Beyond coneangle degrees from z there is none, softly by
   conesoftness of that. */
light rislight(
    float intensity = 1;
    color lightcolor = 1;
    string shape = "sphere";
    float twosided = 0, normalized = 0, focus = 0, coneangle = 90, conesoftness = 0;)
{
    uniform point middle = point "shader" (0, 0, 0);
    uniform vector x = vector "shader" (1, 0, 0), y = vector "shader" (0, 1, 0), z = vector "shader" (0, 0, 1);
    uniform float flat = (shape == "sphere") ? 0 : 1;
    /* What is seen of it from straight ahead. */
    uniform float area = (flat == 1) ? length(x ^ y) : PI / 12 * (x . x + y . y + z . z);
    uniform float power = intensity;
    uniform vector axis = normalize(z);

    if (shape == "disk")
        area *= PI / 4;
    if (normalized == 1)
        power /= max((flat == 1) ? area : 4 * area, 0.000001);
    illuminate(middle) {
        float distance2 = max(L . L, 0.000001);
        float facing = 1;

        if (flat == 1) {
            facing = (L . axis) / sqrt(distance2);
            if (twosided == 1)
                facing = abs(facing);
            facing = clamp(facing, 0, 1);
            if (coneangle < 90)
                facing *= 1 - smoothstep(radians(coneangle * (1 - conesoftness)), radians(coneangle) + 0.001,
                                         acos(facing));
            if (focus > 0)
                facing *= pow(facing, focus);
        }
        Cl = power * facing * area / (PI * distance2 + area) * lightcolor;
    }
}
