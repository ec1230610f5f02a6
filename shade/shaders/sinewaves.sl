/* Waves: moved by amplitude * (sin + sin + sin) / 3 of x, y and z of shader space times frequency, in waves to
   the unit. Amplitude is a length of shader space along its x axis. */
displacement sinewaves(float amplitude = 0.1, frequency = 1;)
{
    point Q = transform("shader", P) * (2 * PI * frequency);
    uniform float unit = length(vector "shader" (1, 0, 0));
    float height = (sin(xcomp(Q)) + sin(ycomp(Q)) + sin(zcomp(Q))) / 3;

    P += amplitude * unit * height * normalize(N);
    N = calculatenormal(P);
}
