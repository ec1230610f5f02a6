/* Normals for shading, as headers of PRMan's shaders call them. */
#ifndef NORMALS_H
#define NORMALS_H

/* Of unit length, and turned to the viewer where a surface has two sides or a ray has found it. */
normal shadingnormal(normal N)
{
    extern vector I;
    uniform float sides = 2, depth = 0;
    normal Ns = normalize(N);

    attribute("Sides", sides);
    rayinfo("depth", depth);
    if (sides == 2 || depth > 0)
        Ns = faceforward(Ns, I, Ns);
    return Ns;
}

#endif
