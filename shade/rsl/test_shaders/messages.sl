/* Shaders that ask each other, and strings. */
surface messages(string note = "a \"quoted\" \\ text\n" "joined"; float level = 1)
{
    uniform string pass = "", name = shadername(), volume_name = shadername("atmosphere");
    uniform float value = 0;
    float bump = 0; color tint = 1; uniform float res[2] = {0, 0};
    if (option("user:pass", pass) != 0 && match("bake.*", pass) == 1) printf("%s: %f %c %p\n", note, level, tint, P);
    if (attribute("identifier:name", name) == 0) name = format("%s-%d", concat("none", "-", name), level);
    displacement("bump", bump);
    atmosphere("density", value);
    surface("Kd", value);
    rendererinfo("version", res);
    incident("tint", tint); opposite("tint", tint);
    illuminance("key&-fill", P, N, PI / 2) {
        string category = "";
        lightsource("__category", category);
        if (category == "key") Ci += Cl * value; else Ci += .5 * Cl;
    }
    Oi = Os * tint;
}
