/* As Pixar's: no pixel is brighter than its alpha, so that it can be kept in an integer format. */
imager clamptoalpha()
{
    alpha = clamp(alpha, 0, 1);
    Ci = clamp(Ci, color (0, 0, 0), color (alpha, alpha, alpha));
}
