/* Output arguments of every type, arrays among them. */
void frame(normal N; output vector x, y; output matrix m) {
    x = normalize(vector(0, 1, 0) ^ N); y = N ^ x;
    setcomp(m, 0, 0, xcomp(x));
}
float sum(float a[]; uniform float n) {
    float total = 0; uniform float i;
    for (i = 0; i < n; i += 1) total += a[i];
    return total;
}
void fill(output float a[4]; float start) { uniform float i; for (i = 0; i < 4; i += 1) a[i] = start + i; }
void names(output string s; string d) { s = d; }
surface outputs(output varying color diffuse_part = 0, specular_part = 0; output varying normal facing = 0)
{
    vector a, b; matrix m = 1; float values[4]; string text;
    color layers[2] = {0, 1};
    facing = normalize(N);
    frame(facing, a, b, m);
    fill(values, 1);
    names(text, "done");
    void swap(output color x, y) { color z = x; x = y; y = z; }
    swap(layers[0], layers[1]);
    diffuse_part = diffuse(facing) * layers[0];
    specular_part = specular(facing, -normalize(I), .1) * sum(values, 4);
    if (text == "done") Ci = diffuse_part + specular_part;
    Oi = 1;
}
