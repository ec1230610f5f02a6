/* Displacement by an amount in a space's units. */
#ifndef DISPLACE_H
#define DISPLACE_H 1

/* P moves along dir by amp units of the space, truedisp of it really and the rest as bumps: the new unit normal. */
normal Displace(vector dir; string space; float amp; float truedisp;)
{
    extern point P;
    vector offset = dir * (amp / max(length(vtransform(space, dir)), 1.0e-6));

    P += truedisp * offset;
    return normalize(calculatenormal(P + (1 - truedisp) * offset));
}

#endif
