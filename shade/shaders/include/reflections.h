/* What a surface mirrors: an environment map, with parallax where it is that of a sphere about the scene, a map of a flat
   mirror's reflection, or a ray. */
#ifndef REFLECTIONS_H
#define REFLECTIONS_H 1

#include "filterwidth.h"
#include "raysphere.h"

/* A shader's parameters for its environment, in its list of parameters and in that of a function, and as arguments. */
#define ENVPARAMS envname, envspace, envrad
#define DECLARE_ENVPARAMS string envname, envspace; uniform float envrad
#define DECLARE_DEFAULTED_ENVPARAMS string envname = "", envspace = "world"; uniform float envrad = 1

/* The environment along R from P, R in "current" space. A map called "reflection" or "trace" is a ray. With envrad above 0 the
   map is that of a sphere of this radius about the origin of envspace. alpha is how much the map covers. */
color Environment(string envname, envspace; uniform float envrad; point P; vector R; float blur; output float alpha;)
{
    color seen = 0;

    alpha = 1;
    if (envname == "reflection" || envname == "trace") {
        seen = trace(P, R);
    } else if (envname != "") {
        vector towards = normalize(vtransform(envspace, R));
        if (envrad > 0) {
            point from = transform(envspace, P);
            float nearest = 0, farthest = 0;
            float hits = raysphere(from, towards, envrad, 1.0e-4, nearest, farthest);
            if (hits > 0)
                towards = (vector from) + towards * nearest;
        }
        alpha = float environment(envname[3], towards, "blur", blur, "fill", 1);
        seen = color environment(envname, towards, "blur", blur);
    } else {
        alpha = 0;
    }
    return seen;
}

/* The map that a camera took of a flat mirror's reflection, where P lies on the picture. */
color ReflMap(string reflname; point P; float blur; output float alpha;)
{
    point at = transform("NDC", P);
    float across = xcomp(at), down = ycomp(at);

    alpha = float texture(reflname[3], across, down, "blur", blur, "fill", 1);
    return color texture(reflname, across, down, "blur", blur);
}

/* Kr times what lies along R; envspace "NDC" names a flat mirror's map. */
color SampleEnvironment(point P; vector R; float Kr, blur; DECLARE_ENVPARAMS;)
{
    color seen = 0;
    float alpha = 0;

    if (envname != "") {
        if (envspace == "NDC")
            seen = ReflMap(envname, P, blur, alpha);
        else
            seen = Environment(envname, envspace, envrad, P, R, blur, alpha);
    }
    return Kr * seen;
}

#endif
