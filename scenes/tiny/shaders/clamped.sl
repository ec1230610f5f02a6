/* A picture that goes on outside with the colours of its edges. */
surface clamped(string texturename = "";)
{
    Oi = Os;
    Ci = Os * Cs * ambient() * color texture(texturename, s, t, "wrap", "clamp");
}
