/* RISpec 3.2, A.3.1: fades to background from mindistance to maxdistance along the view. */
volume depthcue(float mindistance = 0, maxdistance = 1; color background = 0;)
{
    float d = clamp((depth(P) - mindistance) / (maxdistance - mindistance), 0, 1);

    Ci = mix(Ci, background, d);
    Oi = mix(Oi, color (1, 1, 1), d);
}
