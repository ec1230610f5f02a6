/* Solid veined marble. veinfreq veins to the unit of shader space, bent by turbulence; sharpness draws them
   thinner. */
surface marble(
    float Ka = 0.2, Kd = 0.75, Ks = 0.4, roughness = 0.07, txtscale = 1, veinfreq = 1, sharpness = 14,
          turbulence = 2.2;
    color basecolor = color (0.86, 0.84, 0.80), veincolor = color (0.16, 0.17, 0.20),
          specularcolor = 1;
    output varying color albedo = 0;)
{
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    point Q = transform("shader", P) * txtscale;
    float pixel = sqrt(area(P)) * txtscale * length(vtransform("shader", normalize(dPdu)));
    uniform float octave;
    uniform float freq = 1;
    float amount = 0, vein, cloud;
    color Ct;

    /* Octaves finer than the shading rate would only alias. */
    for (octave = 0; octave < 6; octave += 1) {
        float kept = 1 - smoothstep(0.25, 0.75, pixel * freq);
        amount += kept * abs(3 * noise(Q * freq) - 1.5) / freq;
        freq *= 2;
    }
    vein = 0.5 + 0.5 * sin(2 * PI * veinfreq * (xcomp(Q) + 0.4 * ycomp(Q)) + PI * turbulence * amount);
    cloud = smoothstep(0.2, 0.9, amount);
    Ct = mix(basecolor, 0.7 * basecolor + 0.3 * veincolor, 0.6 * cloud);
    Ct = Cs * mix(Ct, veincolor, 0.85 * pow(vein, sharpness));
    albedo = Os * Ct;
    Oi = Os;
    Ci = Os * (Ct * (Ka * ambient() + Kd * diffuse(Nf)) + specularcolor * Ks * specular(Nf, V, roughness));
}
