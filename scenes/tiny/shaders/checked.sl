/* Squares of s and t, filtered over what a vertex stands for. */
#include "filterwidth.h"

float light_part(float x; float width) {
    float from = x - width / 2, to = x + width / 2;
    float until_to = floor(to) / 2 + max(0, to - floor(to) - .5);
    float until_from = floor(from) / 2 + max(0, from - floor(from) - .5);
    return (until_to - until_from) / width;
}

surface checked() {
    float across = light_part(s, filterwidth(s)), along = light_part(t, filterwidth(t));
    Oi = Os;
    Ci = Oi * mix(color(.05, .05, .1), color(.9, .9, .8), across + along - 2 * across * along);
}
