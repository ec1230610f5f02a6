surface brushed(float Ka = 1, Kd = .5, Ks = .5, roughness = .1; color specularcolor = 1; float streaks = 200)
{
    float streak = noise(streaks * t, s * 4);
    normal Nf = faceforward(normalize(N + dPdv * (streak - .5) * .1), I);
    Oi = Os;
    Ci = Os * (Cs * (Ka * ambient() + Kd * diffuse(Nf)) + specularcolor * Ks * specular(Nf, -normalize(I), roughness));
}
