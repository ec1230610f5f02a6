/* An imager of the scene's own: darker towards the corners, by the pixel's place, in pixels. */
imager vignette(float x = 48, y = 32, radius = 60)
{
    float dx = (xcomp(P) - x) / radius;
    float dy = (ycomp(P) - y) / radius;

    Ci *= clamp(1 - (dx * dx + dy * dy), 0, 1);
}
