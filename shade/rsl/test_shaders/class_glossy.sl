// A class of RSL 2 that is a surface: members, methods that the renderer calls, and others before they stand.
class class_glossy(float Kd = .7; float Ks = .4; output varying color o_diffuse = 0;)
{
    varying normal n = 0;
    constant float samples = 4;
    uniform float weights[3] = {.25, .5, .25};
    color base = color(.2, .5, .8);

    public void construct() { base *= weights[1]; }
    public void begin() { n = normalize(N); }
    public void opacity(output color Oi) { Oi = Os; }
    public void prelighting(output color Ci, Oi) { base *= tint(s); }
    public void lighting(output color Ci, Oi)
    {
        normal Nf = faceforward(n, I);
        o_diffuse = diffuse(Nf);
        shine(Nf, Ci);
        Ci *= Oi;
    }
    void shine(normal Nf; output color c)
    {
        uniform float i;
        c = base * Kd * o_diffuse;
        for (i = 0; i < samples; i += 1)
            c += Ks / samples * specular(Nf, -normalize(I), .1 * (i + 1));
    }
    private color tint(float x) { return mix(color(1, 1, 1), color(1, 1, 0), x); }
}
