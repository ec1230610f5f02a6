/* How an area light of a path tracer looks, to the camera: radiance times what rislight makes of the direction to the
   eye. focus, coneangle, conesoftness: as of rislight. */
surface rislightsurface(
    color radiance = 1;
    float focus = 0, coneangle = 90, conesoftness = 0;)
{
    float facing = clamp(-(normalize(I) . normalize(N)), 0, 1);
    float shines = 1;

    if (coneangle < 90)
        shines = 1 - smoothstep(radians(coneangle * (1 - conesoftness)), radians(coneangle) + 0.001, acos(facing));
    if (focus > 0)
        shines *= pow(facing, focus);
    Oi = Os;
    Ci = Os * shines * radiance;
}
