/* A picture as it is read, unlit. */
surface picture(string name = ""; string numbers = "";)
{
    Ci = color texture(name, "colorspace", numbers);
    Oi = 1;
}
