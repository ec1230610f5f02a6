/* A later layer: paint where another says so. */
surface paint_layer(varying float amount = 0; color paint = color(0.9, 0.2, 0.1); float Kd = 0.8;)
{
    normal Nf = faceforward(normalize(N), I);
    Oi = Os;
    Ci = Os * mix(Cs, paint, amount) * (ambient() + Kd * diffuse(Nf));
}
