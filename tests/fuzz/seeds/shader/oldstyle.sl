/* Written as in 1989: points for all, parameters between commas, no casts. */
surface
oldstyle( float Ks=.5, Kd=.5, Ka=1, roughness=.1; color specularcolor=1; string texturename=""; point center = point "shader" (0,0,0) )
{
    point Nf, V; varying color Ct;
    float ss, tt, diff;

    Nf = faceforward( normalize(N), I );
    V = -normalize(I);
    ss = s*2; tt = t*2;
    if( texturename != "" ) Ct = color texture( texturename, ss, tt );
    else Ct = Cs;
    diff = length( P - center );
    if (diff > 1) { Ct = Ct / diff; } else if (diff > .5) Ct = mix( Ct, color (1,1,1), diff );
    Oi = Os;
    Ci = Os * ( Ct * (Ka*ambient() + Kd*diffuse(Nf)) + specularcolor * Ks * specular(Nf,V,roughness) ) ;
}
