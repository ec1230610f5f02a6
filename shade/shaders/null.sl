/* Draws nothing. */
surface null()
{
    Oi = 0;
    Ci = 0;
}
