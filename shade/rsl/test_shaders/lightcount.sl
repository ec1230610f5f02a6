surface lightcount() {
    uniform float n = 0; float bright = 0;
    illuminance("", P, (0, 0, 1), PI, "lightcache", "refresh") { n += 1; bright += comp(Cl, 0) + comp(Cl, 1) + comp(Cl, 2); }
    Ci = n / 10; Ci += bright; Oi = 1;
}
