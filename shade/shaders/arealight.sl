/* The light of AreaLightSource: the mean of what the points P of its shape send to Ps, each by the cosine to its normal
   N and the square of the distance. A larger shape is not a brighter one. What rays meet on the way makes shadows,
   of shadowcolor, unless traceshadows is 0. */
light arealight(
    float intensity = 1;
    color lightcolor = 1;
    float traceshadows = 1;
    color shadowcolor = 0;)
{
    illuminate(P, N, PI / 2) {
        float distance2 = max(L . L, 1e-20);

        Cl = intensity * lightcolor * max((L . normalize(N)) / sqrt(distance2), 0) / distance2;
        if (traceshadows == 1)
            Cl *= mix(shadowcolor, color 1, transmission(Ps, P));
    }
}
