/* A lamp over a table, by the RenderMan Interface. Without arguments it renders lamp.exr; with one it writes the scene
 * as RIB: ./lamp lamp.rib. */
#include "ri.h"

static void table(void) {
    RtPoint corners[4] = {{-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}};
    RtColor wood = {0.55f, 0.35f, 0.2f};
    RtFloat diffuse = 0.9f;
    RiAttributeBegin();
    RiColor(wood);
    RiSurface("matte", RI_KD, &diffuse, RI_NULL);
    RiPolygon(4, RI_P, corners, RI_NULL);
    RiAttributeEnd();
}

/* A shade that turns while the shutter is open, of a colour for each of its corners. */
static void shade(void) {
    RtColor colors[4] = {{0.9f, 0.2f, 0.1f}, {0.9f, 0.8f, 0.1f}, {0.1f, 0.4f, 0.9f}, {0.2f, 0.8f, 0.3f}};
    RiAttributeBegin();
    RiSurface("plastic", RI_NULL);
    RiTranslate(0, 1, 0);
    RiMotionBegin(2, 0.0, 1.0);
    RiRotate(0, 0, 1, 0);
    RiRotate(30, 0, 1, 0);
    RiMotionEnd();
    RiRotate(-90, 1, 0, 0);
    RiCone(1, 1.2f, 330, RI_CS, colors, RI_NULL);
    RiAttributeEnd();
}

/* Crumbs: one object, many instances. */
static void crumbs(void) {
    int i;
    RtObjectHandle crumb = RiObjectBegin();
    RiSphere(0.15f, -0.15f, 0.15f, 360, RI_NULL);
    RiObjectEnd();
    for (i = 0; i < 5; ++i) {
        RiTransformBegin();
        RiTranslate(0.6f * (float)i - 1.2f, 0.15f, -1.5f);
        RiObjectInstance(crumb);
        RiTransformEnd();
    }
}

int main(int argc, char** argv) {
    RtFloat fov = 35, intensity = 30, ambient = 0.2f;
    RtPoint lamp = {2, 4, -3};
    RiBegin(argc > 1 ? argv[1] : RI_NULL);
    RiFormat(160, 120, 1);
    RiPixelSamples(4, 4);
    RiPixelFilter(RiGaussianFilter, 2, 2);
    RiShutter(0, 1);
    RiDisplay("lamp.exr", RI_FILE, RI_RGBA, RI_NULL);
    RiProjection(RI_PERSPECTIVE, RI_FOV, &fov, RI_NULL);
    RiTranslate(0, -0.7f, 8);
    RiRotate(-20, 1, 0, 0);
    RiWorldBegin();
    RiLightSource(RI_AMBIENTLIGHT, RI_INTENSITY, &ambient, RI_NULL);
    RiLightSource(RI_POINTLIGHT, RI_INTENSITY, &intensity, RI_FROM, lamp, RI_NULL);
    table();
    shade();
    crumbs();
    RiWorldEnd();
    RiEnd();
    return RiLastError == RIE_NOERROR ? 0 : 1;
}
