# 1 "somewhere/cpped.sl"
# 1 "<built-in>"
# 1 "somewhere/cpped.sl"
#line 12 "other.h"
float twice(float x) { return 2 * x; }
# 3 "somewhere/cpped.sl" 2
surface cpped() { Ci = twice(.5); Oi = 1; }
