/* Hair: lighting along the tangent, opacity along the length. */
surface fur_lighting(float Ka = 1, Kd = .6, Ks = .35, roughness = .15; color rootcolor = (.1,.05,.02), tipcolor = (.8,.7,.6), specularcolor = (1 + 1, 1, 1) / 2;)
{
    vector T = normalize(dPdv), V = -normalize(I);
    color Cdiff = 0, Cspec = 0;
    float cosang;
    illuminance(P) {
        vector nL = normalize(L);
        cosang = cos(abs(acos(T.nL) - acos(-T.V)));
        Cspec += Cl * v * pow(cosang, 1 / roughness);
        Cdiff += Cl * v;
    }
    Oi = Os * (1 - v);
    Ci = Oi * (mix(rootcolor, tipcolor, v) * (Ka * ambient() + Kd * Cdiff) + Ks * Cspec * specularcolor);
}
