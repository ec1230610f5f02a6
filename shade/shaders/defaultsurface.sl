/* What is drawn when no surface is named (RISpec 3.2, A.1): looks at no lights, lit from the eye by the square
   of the cosine. */
surface defaultsurface(float Ka = 0.2, Kd = 0.8;)
{
    float lengths = (I . I) * (N . N);
    float facing = 0;

    if (lengths > 0)
        facing = (I . N) * (I . N) / lengths;
    Oi = Os;
    Ci = Os * Cs * (Ka + Kd * facing);
}
