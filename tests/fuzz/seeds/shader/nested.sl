/* Functions in functions, that change what is around them. */
surface nested(float depth = 1)
{
    color total = 0;
    float calls = 0;
    void count() { extern float calls; calls += 1; }
    color gain(float x) {
        float local = x * 2;
        float inner(float y) { extern float local; return local + y; }
        extern color total;
        total += inner(x);
        count();
        return total;
    }
    if (depth > 0) { color unused = gain(depth); { float calls = 3; gain(calls); } }
    Ci = total * calls; Oi = 1;
}
