/* A picture as it is read, unlit, that goes on outside with the colours of its edges. */
surface picture(string name = ""; string numbers = "";)
{
    Ci = color texture(name, "colorspace", numbers, "wrap", "clamp");
    Oi = 1;
}
