/* Two shaders in a file share functions that name their variables. */
float scaled() { extern float Kd; extern point P; return Kd * zcomp(P); }
color shaded(normal n) { return diffuse(n) * scaled(); }
surface first(float Kd = .5) { Ci = shaded(normalize(N)); Oi = 1; }
surface second(float Kd = .7; string note = "") { Ci = Cs * scaled(); Oi = shaded(normalize(N)); }
