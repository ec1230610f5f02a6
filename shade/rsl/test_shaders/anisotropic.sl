/* Ward's highlights, with lights that opt out of specular or diffuse. */
color wardhighlight(normal N; vector V; vector xdir; float xroughness, yroughness;)
{
    extern point P;
    float sqr(float x) { return x * x; }

    float cos_theta_r = clamp(N . V, 0.0001, 1);
    vector X = xdir / xroughness;
    vector Y = (N ^ xdir) / yroughness;

    color C = 0;
    illuminance(P, N, PI / 2) {
        extern vector L;
        extern color Cl;
        float nonspec = 0;
        lightsource("__nonspecular", nonspec);
        if (nonspec < 1) {
            vector LN = normalize(L);
            float cos_theta_i = LN . N;
            if (cos_theta_i > 0.0) {
                vector H = normalize(V + LN);
                float rho = exp(-2 * (sqr(X . H) + sqr(Y . H)) / (1 + H . N)) / sqrt(cos_theta_i * cos_theta_r);
                C += Cl * ((1 - nonspec) * cos_theta_i * rho);
            }
        }
    }
    return C / (4 * xroughness * yroughness);
}

surface anisotropic(float Ka = 1, Kd = .1, Ks = .9; float xroughness = .3, yroughness = .05;
                    color specularcolor = 1;)
{
    normal Nf = normalize(faceforward(normalize(N), I, N));
    vector V = -normalize(I);
    Ci = Cs * (Ka * ambient() + Kd * diffuse(Nf))
         + specularcolor * Ks * wardhighlight(Nf, V, normalize(dPdu), xroughness, yroughness);
    Oi = Os;  Ci *= Oi;
}
