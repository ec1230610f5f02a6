surface windows(float frequency = 4) { Ci = mod(floor(s * frequency) + floor(t * frequency), 2); Oi = 1; }
