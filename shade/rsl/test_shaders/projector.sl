light projector(float intensity = 1; string slide = ""; point from = point "shader" (0,0,0); float fov = radians(60))
{
    uniform float angle = fov * sqrt(2) / 2;
    illuminate(from, vector "shader" (0, 0, 1), angle) {
        point Pl = transform("shader", Ps);
        float z = zcomp(Pl), k = 1 / tan(fov / 2);
        float ss = xcomp(Pl) * k / z / 2 + .5, tt = .5 - ycomp(Pl) * k / z / 2;
        if (ss >= 0 && ss <= 1 && tt >= 0 && tt <= 1) Cl = intensity * color texture(slide, ss, tt);
        else Cl = 0;
        Cl *= 1 - shadow("s.shd", Ps);
    }
}
