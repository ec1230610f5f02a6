/* What lights are told by loops over them. */
surface sender(float Kd = 1; string how = "refresh"; float weights[3] = {.2, .3, .5};) {
    normal n = normalize(faceforward(N, I));
    vector way = reflect(normalize(I), n);
    color sum = 0, heard = 0;
    float gain = Kd, parts[2] = {s, t};
    illuminance("environment", P, n, PI / 2, "send:light:axis", way, "send:light:gain", gain * s,
                "light:heard", heard, "lightcache", how) {
        gain += 1;
        sum += Cl * (normalize(L) . n) + heard;
    }
    illuminance(P, "send:light:weights", weights, "send:light:parts", parts, "send:light:map", "") {
        parts[1] = 3;
        if (comp(Cl, 0) > 0.5) {
            illuminance("", P, "send:light:tint", sum, "send:light:place", matrix 2) sum += Cl;
            break;
        }
    }
    illuminance(P, "lightcache", "refresh") sum += Cl;
    Oi = Os;
    Ci = Oi * Cs * sum;
}
