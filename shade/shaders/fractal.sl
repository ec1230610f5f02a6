/* Terrain: ridges of a multifractal, rough where they are high, moved along the normal by up to about amplitude
   (a length of shader space along its x axis). frequency: of the first octave; lacunarity: from one octave to
   the next; H: how much smoother than its neighbours the ground is (0 rough, 1 smooth). */
displacement fractal(
    float amplitude = 0.3, frequency = 1, octaves = 6, lacunarity = 2.1, H = 0.9, offset = 1, gain = 2;)
{
    point Q = transform("shader", P) * frequency;
    uniform float unit = length(vector "shader" (1, 0, 0));
    uniform float count = clamp(floor(octaves), 1, 12);
    uniform float octave;
    uniform float weight = 1, total = 0;
    float height = 0, signal, rough = 1;

    for (octave = 0; octave < count; octave += 1) {
        signal = offset - abs(3 * noise(Q) - 1.5);
        signal *= signal * rough;
        height += weight * signal;
        total += weight;
        rough = clamp(signal * gain, 0, 1);
        weight *= pow(lacunarity, -H);
        Q *= lacunarity;
    }
    P += amplitude * unit * height / total * normalize(N);
    N = calculatenormal(P);
}
