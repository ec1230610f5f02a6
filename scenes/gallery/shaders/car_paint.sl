/* Paint under a clear coat, or dark glass: what rays show of the surroundings, by Schlick 1994 from `mirror`, over
   light by diffuse() and an even light from all around, which occlusion() holds off. */
surface car_paint(float Kd = .8, mirror = .05, samples = 8, blur = .002, around = 32;
                  color ambience = color(.30, .22, .14);)
{
    normal Nf = faceforward(normalize(N), I);
    vector In = normalize(I);
    float kr = mirror + (1 - mirror) * pow(1 - abs(In . Nf), 5);
    float first = 1 - min(1, raydepth());
    float hidden = 0;
    if (first > 0) hidden = occlusion(P, Nf, around, "maxdist", 2.5);
    color seen = trace(P, reflect(In, Nf), "samples", mix(1, samples, first), "samplecone", blur);
    Oi = Os;
    Ci = Oi * ((1 - kr) * Cs * (Kd * diffuse(Nf) + ambience) * (1 - hidden) + kr * seen);
}
