float safe_divide(float a, b) {
    if (b == 0) return 0;
    return a / b;
}
float classify(float x) {
    uniform float i;
    for (i = 0; i < 4; i += 1) {
        if (x < i * .25) return i;
        else if (x < 0) { return -1; }
    }
    return 4;
}
surface early_return() {
    Ci = 0; Oi = 1;
    if (s > .9) return;
    Ci = safe_divide(classify(s), t);
    { if (t > .5) { return; } Ci += 1; }
}
