/* Plastic that tells what it did: its diffuse and specular parts, and how much it faces the eye. */
surface measured(float Ka = 1, Kd = .6, Ks = .4, roughness = .1;
                 output varying color diffuse_part = 0, specular_part = 0;
                 output varying float facing = 0;)
{
    normal n = faceforward(normalize(N), I);
    vector v = -normalize(I);

    facing = n . v;
    diffuse_part = Os * Cs * (Ka * ambient() + Kd * diffuse(n));
    specular_part = Os * Ks * specular(n, v, roughness);
    Oi = Os;
    Ci = diffuse_part + specular_part;
}
