/* RISpec 3.2, A.4.1: moved along the normal by a texture over s and t, Km being the height of its white. The
   smooth part of the normal, N - Ng, is kept. */
displacement bumpy(float Km = 1; string texturename = "";)
{
    normal smooth = normalize(N) - normalize(Ng);

    if (texturename != "") {
        float amplitude = Km * float texture(texturename, s, t);
        P += amplitude * normalize(N);
        N = normalize(calculatenormal(P)) + smooth;
    }
}
