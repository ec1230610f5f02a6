// Toon shading with anti-aliased edges; untyped functions.
#define S(e0, e1, x) smoothstep(e0, e1, x)
ink(normal n; vector i; uniform float width) { float a = abs(n . i); return 1 - S(width, width + .05, a); }
report(string what;) { printf("%s\n", what); }
surface toon(
    uniform float bands = 3,
    inkwidth = .2; color inkcolor = 0;
)
{
    normal Nn = normalize(N);
    float level = 0;
    illuminance(P, Nn, PI/2) level += comp(Cl, 0) * max(0, Nn.normalize(L));
    level = floor(level * bands) / bands;
    if (level < 0) report("negative");
    Ci = mix(Cs * level, inkcolor, ink(Nn, normalize(-I), inkwidth));
    Oi = Os; Ci *= Oi;
}
