/* Dents: moved inwards by amplitude * |noise|, summed over octaves from frequency (to the unit of shader space)
   up. Amplitude is a length of shader space along its x axis; Km scales it. */
displacement dented(float Km = 1, amplitude = 0.1, frequency = 1, octaves = 3;)
{
    point Q = transform("shader", P) * frequency;
    uniform float unit = length(vector "shader" (1, 0, 0));
    uniform float count = clamp(floor(octaves), 1, 8);
    uniform float octave;
    uniform float weight = 1;
    float depth = 0;

    for (octave = 0; octave < count; octave += 1) {
        depth += weight * abs(3 * noise(Q) - 1.5);
        Q *= 2;
        weight /= 2;
    }
    P -= Km * amplitude * unit * depth * normalize(N);
    N = calculatenormal(P);
}
