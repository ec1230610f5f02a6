/* What the ray tracer is asked for. */
surface raytraced(float Kr = .5, eta = 1.5; uniform float samples = 16, maxdist = 1e30; float bias = -1)
{
    normal Nn = normalize(N), Nf = faceforward(Nn, I);
    vector In = normalize(I), R, T;
    float kr, kt;
    fresnel(In, Nf, (In . Nn < 0) ? 1 / eta : eta, kr, kt, R, T);
    color refl = trace(P, R), refr = trace(P, T, "bias", bias);
    float hit = trace(P, R);
    float occ = occlusion(P, Nf, samples, "maxdist", maxdist, "coneangle", PI / 2);
    color bleed = indirectdiffuse(P, Nf, samples, "maxdist", maxdist);
    color through = transmission(P, P + Nf, "samples", 4);
    color soft = 0, hitc = 0; float raylen = 0, total = 0; vector dir = 0;
    gather("illuminance", P, R, .1, samples, "surface:Ci", hitc, "ray:length", raylen, "ray:direction", dir, "bias", bias) {
        soft += hitc;
        total += 1;
    } else {
        soft += environment("sky.tx", dir);
    }
    string sent = samples > 3 ? "send:volume:fog" : "send:surface:fog";
    float weights[2] = {s, t}, grown[];
    push(grown, s);
    gather("", P, R, .1, samples, "surface:Ci", hitc, "send:surface:way", R, "send:surface:weights", weights,
           "send:displacement:grown", grown, "send:atmosphere:map", "a.tx", sent, Cs) {
        weights[0] += 1;
        push(grown, t);
        soft += hitc;
    }
    uniform float depth = 0;
    rayinfo("depth", depth);
    if (raylevel() > 2 || depth > 3) return;
    Ci = Kr * (kr * refl + kt * refr) + (1 - occ) * bleed * through + soft / max(total, 1);
    Ci *= hit > 0 ? visibility(P, P + Nn) : 1;
    Oi = Os;
}
