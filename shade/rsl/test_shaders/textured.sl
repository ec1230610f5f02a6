/* Every way to look a map up. */
surface textured(string maps[3] = {"base.tx", "detail.tx", ""}; string env = ""; string shad = "shadow.tx";
                 float blur = 0; float channel = 1;)
{
    color base = texture(maps[0]);
    float mask = texture(maps[1][3], s, t, "blur", blur, "filter", "gaussian");
    float alpha = float texture("matte.tx"[channel], s, t);
    color wide = color texture(maps[0], s, t, s + du, t, s, t + dv, s + du, t + dv, "swidth", 2, "twidth", 2);
    vector R = reflect(normalize(I), normalize(N));
    R = vtransform("world", R);
    color around = 0;
    if (env != "")
        around = environment(env, R, "blur", .01 + blur);
    float one = environment(env[1], R, R, R, R);
    float lit = 1 - shadow(shad, P, "bias", .01, "samples", 16);
    point bumped = P;
    float got[2] = {0, 0};
    if (textureinfo(maps[0], "resolution", got) == 1)
        base *= got[0] > 512 ? color 1 : color (.5, .5, .5);
    Ci = (base * mask + wide * (1 - mask)) * lit + around * one;
    Oi = alpha;
    Ci *= Oi;
}
