/* Glass that shows what rays see and nothing else: lights are in it where they are geometry. What the eye sees divides
   into both ways; rays behind go on through, or are reflected where all is, so that they do not double at each surface.
   Opacity is for shadows alone: Attribute "shade" "transmissionhitmode" "primitive". */
surface clear_glass(float eta = 1.5; color tint = 1;)
{
    normal Nn = normalize(N);
    normal Nf = faceforward(Nn, I);
    vector In = normalize(I), R, T;
    float kr, kt;
    fresnel(In, Nf, (In . Nn < 0) ? 1 / eta : eta, kr, kt, R, T);
    Oi = 1;
    if (kt == 0) {
        Ci = trace(P, R);
    } else if (raydepth() > 0) {
        Ci = tint * trace(P, T);
    } else {
        Ci = kr * trace(P, R) + kt * tint * trace(P, T);
    }
}
