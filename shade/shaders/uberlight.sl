/* A light of many controls for film, with the parameters that RIB files pass to lights of this name
   [Barzel97, "Lighting Controls for Computer Cinematography"].

   It looks from the origin of its space along +z. lighttype "spot" shines through a superellipse of width by
   height (half sizes, at z = 1; roundness 0 a rectangle, 1 an ellipse) with soft edges of wedge by hedge, sheared
   by shearx and sheary; "omni" shines all around; "arealight" as omni. parallelrays 1 makes the rays parallel to
   z, the superellipse then has its size at every z. Distances below cuton and beyond cutoff are dark, with soft
   ranges of nearedge and faredge. falloff: the power of the distance, and falloffdist where the light has its
   intensity; within it the light grows to maxintensity at most. slidename: a picture projected by the spot.
   Light in the shadow of shadowmap takes on shadowcolor.
   nonspecular 1: it makes no highlights. */
float superellipse_outside(float x, y, w, h, we, he, roundness)
{
    float result;

    if (roundness < 0.0001) {
        result = 1 - (1 - smoothstep(w, w + we, x)) * (1 - smoothstep(h, h + he, y));
    } else {
        float exponent = 2 / max(roundness, 0.05);
        float inner = pow(x / max(w, 0.00001), exponent) + pow(y / max(h, 0.00001), exponent);
        float outer = pow(x / max(w + we, 0.00001), exponent) + pow(y / max(h + he, 0.00001), exponent);
        /* With the point at 1 on its way from the axis, how far the two borders are. */
        inner = pow(max(inner, 0.0000001), -1 / exponent);
        outer = pow(max(outer, 0.0000001), -1 / exponent);
        result = smoothstep(inner, max(outer, inner + 0.00001), 1);
    }
    return result;
}

light uberlight(
    string lighttype = "spot";
    float intensity = 1;
    color lightcolor = 1;
    float cuton = 0.01, cutoff = 1000000, nearedge = 0, faredge = 0;
    float falloff = 0, falloffdist = 1, maxintensity = 1, parallelrays = 0;
    float shearx = 0, sheary = 0, width = 1, height = 1, wedge = 0.1, hedge = 0.1, roundness = 1,
          beamdistribution = 0;
    string slidename = "";
    float noiseamp = 0, noisefreq = 4;
    vector noiseoffset = 0;
    string shadowmap = "";
    float shadowblur = 0, shadowbias = 0.01, shadownsamps = 16;
    color shadowcolor = 0;
    float nonspecular = 0;
    output varying float __nondiffuse = 0, __nonspecular = 0;
    output float __foglight = 1;)
{
    uniform vector axis = normalize(vector "shader" (0, 0, 1));
    uniform point from = point "shader" (0, 0, 0);
    uniform float is_spot = (lighttype == "spot") ? 1 : 0;
    point PL = transform("shader", Ps);
    uniform float angle = (is_spot == 1 && parallelrays == 0) ? PI / 2 : PI;
    float atten, distance_to, x, y, z, reach;
    color lcol, tint;

    __nonspecular = nonspecular;
    z = zcomp(PL);
    distance_to = (parallelrays == 0) ? length(vector PL) : z;
    x = xcomp(PL) - shearx * z;
    y = ycomp(PL) - sheary * z;
    if (parallelrays == 0) {
        float divisor = max(z, 0.000001);
        x /= divisor;
        y /= divisor;
    }

    atten = smoothstep(cuton - nearedge, cuton, distance_to) *
            (1 - smoothstep(cutoff, cutoff + faredge, distance_to));
    if (falloff != 0) {
        reach = max(distance_to, 0.000001) / falloffdist;
        if (reach > 1)
            atten *= pow(reach, -falloff);
        else
            atten *= min(pow(reach, -falloff), max(maxintensity / max(intensity, 0.000001), 1));
    }
    if (is_spot == 1) {
        if (z <= 0)
            atten = 0;
        else
            atten *= 1 - superellipse_outside(abs(x), abs(y), width, height, wedge, hedge, roundness);
        if (beamdistribution > 0)
            atten *= pow(max(z / max(length(vector PL), 0.000001), 0), beamdistribution);
    }
    lcol = lightcolor;
    if (slidename != "" && is_spot == 1)
        lcol *= color texture(slidename, 0.5 + 0.5 * x / (width + wedge), 0.5 - 0.5 * y / (height + hedge));
    if (noiseamp > 0)
        atten *= max(0, 1 + noiseamp * (2 * noise(noisefreq * point (x, y, 1) + noiseoffset) - 1));

    /* Rays to the light are known in its block alone. */
    if (parallelrays == 0) {
        illuminate(from, axis, angle) {
            tint = lcol;
            if (shadowmap != "")
                tint = mix(lcol, shadowcolor,
                           color shadow(shadowmap, Ps, "samples", shadownsamps, "blur", shadowblur, "bias", shadowbias));
            Cl = atten * intensity * tint;
        }
    } else {
        solar(axis, 0) {
            tint = lcol;
            if (shadowmap != "")
                tint = mix(lcol, shadowcolor,
                           color shadow(shadowmap, Ps, "samples", shadownsamps, "blur", shadowblur, "bias", shadowbias));
            Cl = atten * intensity * tint;
        }
    }
}
