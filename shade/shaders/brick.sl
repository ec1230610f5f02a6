/* A wall of bricks over s * sscale and t * tscale, each row moved by half a brick. Edges are filtered over the
   width of a micropolygon. */
surface brick(
    float Ka = 1, Kd = 1, sscale = 1, tscale = 1, brickwidth = 0.25, brickheight = 0.08, mortarthickness = 0.012,
          rowvary = 0.5, colorvary = 0.35, jagged = 0.011;
    color brickcolor = color (0.52, 0.17, 0.10), mortarcolor = color (0.55, 0.53, 0.48);
    output varying color albedo = 0;)
{
    normal Nf = faceforward(normalize(N), I);
    point Q = transform("shader", P);
    float bw = brickwidth + mortarthickness, bh = brickheight + mortarthickness;
    float ss, tt, row, column, x, y, hx, hy, wx, wy, inside;
    color Ct;

    ss = s * sscale + jagged * (2 * noise(s * sscale * 30, t * tscale * 30) - 1);
    tt = t * tscale + jagged * (2 * noise(s * sscale * 30 + 17, t * tscale * 30 + 5) - 1);
    row = floor(tt / bh);
    ss += rowvary * bw * mod(row, 2);
    column = floor(ss / bw);

    /* Distance from the middle of the brick against half its size. */
    x = abs(ss - (column + 0.5) * bw);
    y = abs(tt - (row + 0.5) * bh);
    hx = 0.5 * brickwidth;
    hy = 0.5 * brickheight;
    wx = max(abs(Du(s) * du) + abs(Dv(s) * dv), 0.0001) * abs(sscale);
    wy = max(abs(Du(t) * du) + abs(Dv(t) * dv), 0.0001) * abs(tscale);
    inside = (1 - smoothstep(hx - wx, hx + wx, x)) * (1 - smoothstep(hy - wy, hy + wy, y));

    Ct = brickcolor * (1 + colorvary * (2 * cellnoise(column + 0.5, row + 0.5) - 1));
    Ct *= 0.81 + 0.85 * noise(Q * 12) * noise(ss * 60, tt * 60);
    Ct = Cs * mix(mortarcolor * (0.72 + 0.56 * noise(ss * 90, tt * 90)), Ct, inside);
    albedo = Os * Ct;
    Oi = Os;
    Ci = Os * Ct * (Ka * ambient() + Kd * diffuse(Nf));
}
