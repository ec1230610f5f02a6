/* Points of space onto textures. Widths ds and dt are those of filters. */
#ifndef PROJECT_H
#define PROJECT_H 1

#include "filterwidth.h"

matrix array_to_mx(float m[16])
{
    return matrix(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11], m[12], m[13], m[14], m[15]);
}

/* A width across the seam, where the coordinate jumps by 1, counts the short way. */
float seamwidth(float width)
{
    return max(min(width, abs(1 - width)), MINFILTWIDTH);
}

/* As pictures of an environment are laid out: ss goes about z, tt from +z (0) down to -z (1). */
void spherical_projection(point p; output float ss, tt, ds, dt;)
{
    vector towards = normalize(vector p);
    ss = (PI - atan(ycomp(towards), xcomp(towards))) / (2 * PI);
    tt = acos(clamp(zcomp(towards), -1, 1)) / PI;
    ds = seamwidth(filterwidth(ss));
    dt = filterwidth(tt);
}

/* ss goes about z, tt along it. */
void cylindrical_projection(point p; output float ss, tt, ds, dt;)
{
    vector towards = normalize(vector p);
    ss = (PI - atan(ycomp(towards), xcomp(towards))) / (2 * PI);
    tt = zcomp(p);
    ds = seamwidth(filterwidth(ss));
    dt = filterwidth(tt);
}

/* projection is "st" (the surface's own coordinates), "planar", "perspective", "spherical" or "cylindrical", in whichspace, and
   then by xform. */
void ProjectTo2D(string projection; point P; string whichspace; matrix xform; output float ss, tt, ds, dt;)
{
    extern float s, t;
    point at = transform(whichspace, P);

    if (projection == "st")
        at = point(s, t, 0);
    at = transform(xform, at);
    if (projection == "spherical") {
        spherical_projection(at, ss, tt, ds, dt);
    } else if (projection == "cylindrical") {
        cylindrical_projection(at, ss, tt, ds, dt);
    } else {
        ss = xcomp(at);
        tt = ycomp(at);
        if (projection == "perspective") {
            ss /= zcomp(at);
            tt /= zcomp(at);
        }
        ds = filterwidth(ss);
        dt = filterwidth(tt);
    }
}

/* A projected texture's colour (multiplied by its alpha, as files hold it), and its alpha, 1 where it has none. */
color GetColorTextureAndAlpha(string texturename, projection; point P; string whichspace; matrix xform; float blur;
                              uniform float alphachannel; output float alpha;)
{
    float ss = 0, tt = 0, ds = 0, dt = 0;

    ProjectTo2D(projection, P, whichspace, xform, ss, tt, ds, dt);
    ds *= 0.5;
    dt *= 0.5;
    alpha = float texture(texturename[alphachannel], ss - ds, tt - dt, ss + ds, tt - dt, ss - ds, tt + dt, ss + ds, tt + dt,
                          "blur", blur, "fill", 1);
    return color texture(texturename, ss - ds, tt - dt, ss + ds, tt - dt, ss - ds, tt + dt, ss + ds, tt + dt, "blur", blur);
}

/* The same of one channel. */
float GetFloatTextureAndAlpha(string texturename; uniform float channel; string projection; point P; string whichspace;
                              matrix xform; float blur; uniform float alphachannel; output float alpha;)
{
    float ss = 0, tt = 0, ds = 0, dt = 0;

    ProjectTo2D(projection, P, whichspace, xform, ss, tt, ds, dt);
    ds *= 0.5;
    dt *= 0.5;
    alpha = float texture(texturename[alphachannel], ss - ds, tt - dt, ss + ds, tt - dt, ss - ds, tt + dt, ss + ds, tt + dt,
                          "blur", blur, "fill", 1);
    return float texture(texturename[channel], ss - ds, tt - dt, ss + ds, tt - dt, ss - ds, tt + dt, ss + ds, tt + dt, "blur",
                         blur);
}

/* The texture over the base. */
color ApplyColorTextureOver(color basecolor; string texturename, projection; point P; string whichspace; matrix xform;
                            float blur;)
{
    float alpha = 1;
    color over = GetColorTextureAndAlpha(texturename, projection, P, whichspace, xform, blur, 3, alpha);
    return over + (1 - alpha) * basecolor;
}

float ApplyFloatTextureOver(float basefloat; string texturename, projection; point P; string whichspace; matrix xform;
                            float blur;)
{
    float alpha = 1;
    float over = GetFloatTextureAndAlpha(texturename, 0, projection, P, whichspace, xform, blur, 1, alpha);
    return over + (1 - alpha) * basefloat;
}

#endif
