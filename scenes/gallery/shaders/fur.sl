/* Hair after Kajiya and Kay 1989, on a ball about the origin of shader space: light falls on hairs as on thin
   cylinders, and is shut out by the hairs outside of them, the more the deeper they lie. */
surface fur(
    float Ka = 1, Kd = .9, Ks = .5, roughness = .06, radius = 1, height = .55;
    color tipcolor = 1;)
{
    vector T = normalize(dPdv), V = -normalize(I);
    vector out = vtransform("shader", "current", transform("shader", P) - point(0, 0, 0));
    float depth = 1 - clamp((length(transform("shader", P) - point(0, 0, 0)) - radius) / height, 0, 1);
    float open = mix(1, .18, depth * depth);
    vector up = normalize(out);
    color diff = 0, spec = 0;

    illuminance(P, up, PI) {
        vector Ln = normalize(L);
        float along = T . Ln, across = sqrt(max(0, 1 - along * along));
        float seen = T . V, side = sqrt(max(0, 1 - seen * seen));
        /* Light from the other side comes through the ball's rim only. */
        float lit = smoothstep(-.35, .6, up . Ln) * mix(1, open, .8);
        diff += Cl * lit * across;
        spec += Cl * lit * pow(max(0, across * side - along * seen), 1 / roughness);
    }
    Oi = Os;
    Ci = Oi * (mix(tipcolor, Cs, smoothstep(0, .9, depth)) * (Ka * ambient() * open + Kd * diff) + Ks * spec);
}
