/* Half transparent, with holes: rays must ask for its opacity. */
surface slats() {
    Oi = Os * step(.5, mod(4 * v, 1));
    Ci = Oi * Cs;
}
