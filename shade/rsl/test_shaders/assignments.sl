/* Assignments as values, and operators of all precedences. */
surface assignments() {
    float a, b, c;
    a = b = c = 1;
    a += b -= c *= 2;
    float d = (a /= 2) + (b = 3);
    vector x = normalize(I), y = dPdu;
    float e = -x . y * 2 + (x ^ y) . (x ^ y);
    float f = a < b == c > d && !(a != b) || a >= c;
    float g = a < b ? c : a > b ? d : e + 1;
    vector z = x ^ y * 2 - -x;
    float h = 1--1 + - - 1;
    Ci = (a + b) * (c - d) / e + f - g * h; Oi = z . z;
}
