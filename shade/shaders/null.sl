/* The surface's own colour and opacity, unshaded: for depth maps, which need no more. */
surface null()
{
    Oi = Os;
    Ci = Os * Cs;
}
