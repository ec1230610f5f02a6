/* Solid speckled granite of three minerals; txtscale times shader space. */
surface granite(
    float Ka = 0.2, Kd = 0.8, Ks = 0.3, roughness = 0.1, txtscale = 1;
    color feldspar = color (0.62, 0.47, 0.42), quartz = color (0.75, 0.74, 0.72), mica = color (0.05, 0.05, 0.06),
          specularcolor = 1;
    output varying color albedo = 0;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    point Q = transform("shader", P) * txtscale * 6;
    uniform float octave;
    uniform float freq = 1, weight = 1;
    float sum = 0, dark, bright;
    color Ct;

    for (octave = 0; octave < 5; octave += 1) {
        sum += weight * abs(0.75 - 1.5 * noise(4 * Q * freq));
        freq *= 2.1;
        weight *= 0.55;
    }
    bright = smoothstep(0.467, 0.567, noise(Q * 3 + vector (7.3, 1.1, 4.2)) + 0.167 * (sum - 0.3));
    dark = smoothstep(0.553, 0.607, noise(Q * 5) + 0.133 * (sum - 0.3));
    Ct = mix(feldspar, quartz, bright) * (0.7 + 0.8 * sum);
    Ct = Cs * mix(Ct, mica, dark);
    albedo = Os * Ct;
    Oi = Os;
    Ci = Os * (Ct * (Ka * ambient() + Kd * diffuse(Nf)) + specularcolor * Ks * specular(Nf, V, roughness));
}
