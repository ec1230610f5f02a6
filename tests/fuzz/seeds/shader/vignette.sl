imager vignette(color background = (.2, .2, .3); float amount = .5; float gamma = 2.2)
{
    float resolution[3] = {640, 480, 1};
    option("Format", resolution);
    float x = xcomp(P) / resolution[0] - .5, y = ycomp(P) / resolution[1] - .5;
    float fade = 1 - amount * (x * x + y * y);
    Ci += (1 - alpha) * background;
    Ci *= fade;
    setcomp(Ci, 0, pow(comp(Ci, 0), 1 / gamma));
    Oi = 1; alpha = 1;
}
