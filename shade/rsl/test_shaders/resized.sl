/* Arrays without a length: those that grow in loops, that functions and methods fill, and of the scene. */
void squares(output float to[]; uniform float n)
{
    uniform float i;
    for (i = 0; i < n; i += 1) push(to, i * i);
}

color blend(color of[]; float at)
{
    float place = at * (arraylength(of) - 1);
    return mix(of[place], of[place + 1], mod(place, 1));
}

class resized(uniform color ramp[] = {}; uniform float knots[] = {0, 0, .2, 1, 1}; uniform string names[] = {};
              output varying float depth = 0;)
{
    color layers[];
    uniform float weights[] = {1, 2};

    void add(color layer; uniform float weight)
    {
        push(layers, layer);
        push(weights, weight);
    }

    public void construct()
    {
        reserve(layers, 8);
    }

    public void begin()
    {
        resize(layers, 1);
        layers[0] = Cs;
        add(color (s, t, 0), 3);
    }

    public void surface(output color Ci, Oi)
    {
        float steps[];
        squares(steps, 4);
        if (s > .5) {
            push(steps, t);
            layers[1] = layers[0];
        }
        float copy[] = steps;
        copy[arraylength(copy) - 1] += spline(s, knots);
        steps = {pop(copy), pop(copy), capacity(layers)};
        depth = steps[2 * t] + arraylength(copy) + arraylength(ramp);
        string name = "";
        if (arraylength(names) > 0) name = names[0];
        color all[] = layers;
        add(1, 2);
        all = layers;
        Ci = blend(all, t) + depth * weights[s * 9];
        if (name == "black") Ci = 0;
        Oi = Os;
    }
}
