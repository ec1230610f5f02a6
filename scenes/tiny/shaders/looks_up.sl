/* Shows a channel of a point cloud, and a colour where there is none. */
surface looks_up(string file = "bake3d.ptc"; color nothing = color(.1, .1, .2); float filterscale = 1;) {
    color lit = nothing;
    texture3d(file, P, normalize(N), "filterscale", filterscale, "_radiosity", lit);
    Ci = lit;
    Oi = Os;
}
