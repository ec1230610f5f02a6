/// Shadows of what is close above a floor, of a light that is far behind all that is seen: where pixels are
/// hundreds of times as large as on the floor. A light that looks from where it is, one that looks from the
/// floor, and a surface that asks for itself see the same.
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

/// The floor is at y = -1, and the eye 1 above it; the light is 1000 times as far away as what is looked at.
const std::string kFarLight = "point(1000, 4000, 3000)";

/// A board of a hundredth of a pixel's thickness, so high above the floor, from x = -1.5 to 1.5 and from
/// z = 2 to 5.
std::string board(float height) {
    const std::string low = std::to_string(-1 + height), high = std::to_string(-1 + height + 0.0005f);
    std::string points;
    for (const std::string& y : {low, high})
        points += "-1.5 " + y + " 2 1.5 " + y + " 2 1.5 " + y + " 5 -1.5 " + y + " 5 ";
    return "PointsPolygons [4 4 4 4 4 4] [0 1 2 3 4 5 6 7 0 1 5 4 1 2 6 5 2 3 7 6 3 0 4 7] \"P\" [" + points +
           "] ";
}

/// `lit` is 0 where the way to the light passes the board, 1 where it passes beside it; `sure` where that is
/// more than 4 pixels from the board's edges. A pixel is 2 / 64 of a point's distance from the eye.
std::string passes(float height) {
    return "vector way = " + kFarLight + " - P; point at = P + way * (" + std::to_string(height) +
           " / ycomp(way)); float pixels = 4 * length(P) / 32;"
           "float within = min(1.5 - abs(xcomp(at)), min(zcomp(at) - 2, 5 - zcomp(at)));"
           "float lit = within > 0 ? 0 : 1, sure = abs(within) > pixels ? 1 : 0; ";
}

Case floor_under_board(float height) {
    Case c;
    c.options = "Projection \"perspective\" \"fov\" 90 ";
    c.asks = "Patch \"bilinear\" \"P\" [-9 -1 9 9 -1 9 -9 -1 1 9 -1 1] ";
    c.things = board(height);
    return c;
}

/// From three pixels of what is under its middle on: rays count from two on.
const float kHeights[] = {0.33f, 0.5f, 0.8f};

void expect_shadow(const Image& image) {
    expect_told(image, 0, 1000);
    int dark = 0;
    for (const Pixel& p : pixels(image)) dark += p.alpha > 0 && p.blue > 0 && p.green == 0;
    EXPECT_GT(dark, 100);
}

TEST(RayContactShadows, AreThoseOfTheBoardForWhoAsksOnTheFloor) {
    for (const float height : kHeights)
        for (const std::string& call :
             {"transmission(P, " + kFarLight + ")", "transmission(" + kFarLight + ", P)"}) {
            SCOPED_TRACE(call + std::to_string(height));
            expect_shadow(floor_under_board(height).render(passes(height) + "color open = " + call +
                                                           "; Ci = told(comp(open, 0), lit, sure);"));
        }
}

TEST(RayContactShadows, AreThoseOfTheBoardForLights) {
    for (const float height : kHeights)
        for (const char* call :
             {"transmission(from, Ps)", "transmission(Ps, from)", "1 - shadow(\"raytrace\", Ps)"}) {
            SCOPED_TRACE(std::string(call) + std::to_string(height));
            Case c = floor_under_board(height);
            c.shaders["shadowed"] = "light shadowed(point from = " + kFarLight +
                                    ";) { illuminate(from) Cl = " + std::string(call) + "; }";
            c.asker = "LightSource \"shadowed\" 1 ";
            expect_shadow(c.render(passes(height) +
                                   "color open = 0; illuminance(P, normal(0, 1, 0), PI / 2) { open += Cl; }"
                                   "Ci = told(comp(open, 0), lit, sure);"));
        }
}

}  // namespace
}  // namespace trapeze::testing
