/* Structs: in structs, in functions, as members of a class. */
struct Range {
    float low = 0, high = 1;
};

struct Coat {
    varying color tint = (1, .5, .25);
    varying float weight = 1;
    float steps[3] = {.25, .5, .75};
    Range range;
    string label = "coat";
    varying point places[];
};

struct Lacquer : Coat {
    uniform float gloss = .1;

    public void dim(float by)
    {
        weight *= by;
        range->high -= by;
    }

    public color highlight(vector V; float size)
    {
        extern normal N;
        dim(.9);
        return tint * weight * specular(normalize(N), V, gloss * size);
    }
}

Range around(float middle)
{
    if (middle < 0)
        return Range();
    return Range(middle - .25, middle + .25);
}

void wear(output Coat coat; Range by; float at)
{
    coat->weight *= smoothstep(by->low, by->high, at);
    coat->range = by;
    push(coat->places, P);
}

class structs(float middle = .5; output varying color worn = 0;)
{
    Coat base = Coat("weight", .5, "range", Range(.1));
    Range window;
    Lacquer lacquer;

    public void begin()
    {
        window = around(middle);
        base->tint *= Cs;
    }

    color shade(Coat coat; uniform float step)
    {
        return coat->tint * coat->weight * coat->steps[step];
    }

    public void surface(output color Ci, Oi)
    {
        Coat second = base;
        wear(second, window, s);
        wear(second, Range("high", 2), t);
        second->range = around(second->range->high);
        if (second->label == base->label && arraylength(second->places) > 1)
            worn = shade(second, 1);
        Ci = Os * (shade(base, 0) + worn * second->range->low);
        lacquer->dim(.5);
        Ci += lacquer->highlight(-normalize(I), 2);
        Oi = Os;
    }
}
