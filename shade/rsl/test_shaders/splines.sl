/* The mathematics, each function once. */
surface splines(float knots[5] = {0, .2, .5, .8, 1}; color ramp[4] = {0, (1, 0, 0), (1, 1, 0), 1}; string basis = "catmull-rom")
{
    float x = spline(s, 0, .1, .4, .9, 1, 1) + spline(basis, t, knots) + spline("linear", s, 0, 0, 1, 1);
    color c = spline(x, color 0, color .2, color (1, .5, 0), color 1, color 1) + spline(s, ramp);
    point p = spline(.5, P, P + N, P - N, P);
    float y = sin(x) + cos(x) + tan(x) + asin(.1) + acos(.2) + atan(x) + atan(x, 2) + pow(x, 3) + exp(x)
            + log(x + 1) + log(x + 2, 2) + sqrt(abs(x)) + inversesqrt(1 + x) + floor(x) + ceil(x) + round(x)
            + sign(x) + mod(x, .3) + min(x, 1, 2, 3) + max(x, 0) + clamp(x, 0, 1) + step(.5, x)
            + filterstep(.5, x) + filterstep(.5, x, x + .1, "filter", "catmull-rom") + smoothstep(0, 1, x) + mix(0, 1, x)
            + radians(180) + degrees(PI);
    float z = Du(x) + Dv(x) + Deriv(x, s) + length(Du(P)) + comp(Du(c), 1) + area(P) + depth(P)
            + distance(P, p) + ptlined(P, p, E) + random() + noise(x) + noise(x, y) + noise(P) + noise(P, time)
            + pnoise(x, 3) + pnoise(x, y, 3, 4) + pnoise(P, point(3, 3, 3)) + pnoise(P, x, p, 4) + cellnoise(P);
    vector v = refract(normalize(I), normalize(N), .9) + vector rotate(P, PI / 4, point 0, point (0, 0, 1));
    color q = color random() + color pnoise(P, point 3) + clamp(c, color 0, color 1) + max(c, 0) + mix(c, color 1, .5);
    Ci = c + q * y * z + color (xcomp(v), ycomp(v), zcomp(v)) + phong(N, v, 10) + specularbrdf(v, N, v, .1);
    Oi = 1;
}
