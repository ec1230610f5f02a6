/* Casts, triples and tuples in all places. */
surface conversions(matrix m = 1; color hues[4] = {color "hsv" (0, 1, 1), (0, 1, 0), 1, color(.5)};
                    uniform float index = 2)
{
    point here = point "world" (0, 0, 1);
    vector up = vector "camera" (0, 1, 0);
    normal flat = normal "shader" (0, 0, 1);
    matrix identity = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
    matrix shear = matrix "object" (1, 0, 0, 0, .5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
    matrix both = m * shear / identity;
    point moved = transform(both, here) + up * .25 - (0, 0, 1);
    float d = determinant(translate(scale(rotate(m, radians(30), (0, 0, 1)), point(2, 2, 2)), up));
    vector cross = (up ^ (1, 0, 0)) ^ vector flat;
    float truth = (here == moved) || !(d > 1 && index != 2);
    setcomp(both, 3, 0, comp(both, 0, 3));
    setxcomp(moved, ycomp(moved)); setycomp(moved, 0);
    color c = hues[index];
    setcomp(c, 0, .5);
    color viaspace = ctransform("hsv", "rgb", c) + ctransform("xyz", c);
    c = color (xcomp(moved), ycomp(moved), zcomp(moved)) + viaspace;
    Ci = truth ? c : (0, 0, xcomp(cross));
    Oi = 1;
}
