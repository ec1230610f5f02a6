#include "noises.h"

displacement rock(float Km = 0.1; uniform float octaves = 6; float lacunarity = 2, gain = .5;
                  string shadingspace = "shader";)
{
    point Pshad = transform(shadingspace, P);
    float fw = filterwidthp(Pshad);
    float amount = Km * fBm(Pshad, fw, octaves, lacunarity, gain);
    P += amount * normalize(N);
    N = calculatenormal(P);
}
