surface grid(float width = .05; uniform float lines = 10; color lc = (1, 1, 0))
{
    float pulse(float edge0, edge1, x) { return step(edge0, x) - step(edge1, x); }
    float filteredpulse(float e0, e1, x, dx) {
        float x0 = x - dx / 2, x1 = x0 + dx;
        return max(0, (min(x1, e1) - max(x0, e0)) / dx);
    }
    float ss = mod(s * lines, 1), tt = mod(t * lines, 1);
    float fw = max(abs(Du(s) * du) + abs(Dv(s) * dv), 1e-6) * lines;
    float on = fw > .5 ? pulse(0, width, ss) : filteredpulse(0, width, ss, fw);
    on = max(on, filteredpulse(0, width, tt, fw));
    Ci = on > 0 ? lc * on : Cs; Oi = Os;
}
