/* The first layer: stripes along s, for a later one. */
surface stripes_layer(float count = 6; output varying float mask = 0;)
{
    mask = smoothstep(-0.1, 0.1, sin(2 * PI * count * s));
    Ci = 0;
    Oi = Os;
}
