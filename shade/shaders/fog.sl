/* RISpec 3.2, A.3.2: exponential fog; distance is where 1 / e of the light is left. */
volume fog(float distance = 1; color background = 0;)
{
    float d = 1 - exp(-length(I) / distance);

    Ci = mix(Ci, background, d);
    Oi = mix(Oi, color (1, 1, 1), d);
}
