surface weave(float sfreq = 20, tfreq = 20; color warp = (.6, .2, .2), weft = (.2, .2, .6))
{
#define boxstep(a,b,x) clamp(((x)-(a))/((b)-(a)),0,1)
    float ss = s * sfreq, tt = t * tfreq;
    float row = floor(tt), column = floor(ss);
    float odd = mod(row + column, 2);
    float x = ss - column - .5, y = tt - row - .5;
    float height = odd == 0 ? sqrt(1 - 4 * x * x) : sqrt(1 - 4 * y * y);
    color Ct = odd == 0 ? warp : weft;
    Ct *= boxstep(0, 1, height);
    normal Nn = normalize(calculatenormal(P + .01 * height * normalize(N)));
    Ci = Ct * diffuse(faceforward(Nn, I)); Oi = 1;
}
