/* RISpec 3.2, A.1.1: the colour and opacity of the primitive, unlit. */
surface constant()
{
    Oi = Os;
    Ci = Os * Cs;
}
