/* What is drawn when no surface is named (RISpec 3.2, A.1): looks at no lights, lit from the eye by the square
   of the cosine. */
surface defaultsurface(float Ka = 0.2, Kd = 0.8;)
{
    float facing = normalize(I) . normalize(N);

    Oi = Os;
    Ci = Os * Cs * (Ka + Kd * facing * facing);
}
