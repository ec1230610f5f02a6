/* Moves all of a surface down by a length in the world. */
displacement sink(float depth = 1;) {
    P += vtransform("world", "current", vector(0, -depth, 0));
}
