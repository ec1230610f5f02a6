/// Lights of AreaLightSource next to an integral over their shapes, which is made here from the
/// specification's formulas of these: near by, where a shape fills much of the sky and is partly below the
/// horizon, and from afar. What "arealight" gives is the mean over the shape of both cosines over the squared
/// distance.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "tests/area_lights_harness.h"

namespace trapeze::testing {
namespace {

struct Place {
    double x = 0, y = 0, z = 0;

    Place operator+(const Place& b) const { return {x + b.x, y + b.y, z + b.z}; }
    Place operator-(const Place& b) const { return {x - b.x, y - b.y, z - b.z}; }
    Place operator*(double s) const { return {x * s, y * s, z * s}; }
    double dot(const Place& b) const { return x * b.x + y * b.y + z * b.z; }
    Place cross(const Place& b) const { return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x}; }
};

/// A shape, as RIB and as a surface over u and v from 0 to 1. Its outside is where dPdu x dPdv leads, by the
/// right hand's rule.
struct LightForm {
    const char* name;
    std::string rib;
    std::function<Place(double, double)> surface;
};

void PrintTo(const LightForm& form, std::ostream* out) {
    *out << form.name;
}

constexpr double kDegree = std::numbers::pi / 180;

/// Around z, at a radius and a height that go with v, up to so many degrees.
std::function<Place(double, double)> turned(double degrees, const std::function<Place(double)>& outline) {
    return [=](double u, double v) {
        const Place at = outline(v);
        const double turn = u * degrees * kDegree, c = std::cos(turn), s = std::sin(turn);
        return Place{at.x * c - at.y * s, at.x * s + at.y * c, at.z};
    };
}

/// The circle in the plane of x and z, about x = middle.
Place on_circle(double middle, double radius, double degrees) {
    return {middle + radius * std::cos(degrees * kDegree), 0, radius * std::sin(degrees * kDegree)};
}

double mixed(double from, double to, double part) {
    return from + (to - from) * part;
}

/// Bezier's weight of a control point.
double bezier(int i, double t) {
    constexpr double kTimes[] = {1, 3, 3, 1};
    return kTimes[i] * std::pow(t, i) * std::pow(1 - t, 3 - i);
}

/// One table, however long: a row is read next to the others.
std::vector<LightForm> light_forms() {
    constexpr double kHills[4][4] = {{0, .4, 0, -.2}, {.2, .6, -.6, 0}, {.4, -.2, .8, .2}, {0, .2, -.2, .4}};
    std::string hills;
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i)
            for (const double x : {i / 3. - .5, j / 3. - .5, kHills[j][i]}) hills += std::to_string(x) + ' ';
    return {
        {"Polygon", "Polygon \"P\" [-.5 -.3 0 .5 -.3 0 .5 .3 0 -.5 .3 0] ",
         [](double u, double v) {
             return Place{u - .5, .6 * v - .3, 0};
         }},
        {"BilinearPatch", "Patch \"bilinear\" \"P\" [-.5 -.3 -.2 .5 -.3 .3 -.4 .3 .2 .6 .4 -.3] ",
         [](double u, double v) {
             return (Place{-.5, -.3, -.2} * (1 - u) + Place{.5, -.3, .3} * u) * (1 - v) +
                    (Place{-.4, .3, .2} * (1 - u) + Place{.6, .4, -.3} * u) * v;
         }},
        {"BicubicPatch", "Patch \"bicubic\" \"P\" [" + hills + "] ",
         [=](double u, double v) {
             Place sum;
             for (int j = 0; j < 4; ++j)
                 for (int i = 0; i < 4; ++i)
                     sum =
                         sum + Place{i / 3. - .5, j / 3. - .5, kHills[j][i]} * (bezier(i, u) * bezier(j, v));
             return sum;
         }},
        {"Sphere", "Sphere .5 -.5 .5 360 ",
         turned(360, [](double v) { return on_circle(0, .5, mixed(-90, 90, v)); })},
        {"PartOfASphere", "Sphere .5 -.25 .4 250 ",
         turned(250, [](double v) { return on_circle(0, .5, mixed(-30, std::asin(.8) / kDegree, v)); })},
        {"Cylinder", "Cylinder .3 -.5 .5 360 ",
         turned(360,
                [](double v) {
                    return Place{.3, 0, v - .5};
                })},
        {"PartOfACylinder", "Cylinder .3 -.2 .5 130 ",
         turned(130,
                [](double v) {
                    return Place{.3, 0, mixed(-.2, .5, v)};
                })},
        {"Cone", "Cone .9 .4 360 ",
         turned(360,
                [](double v) {
                    return Place{.4 * (1 - v), 0, .9 * v};
                })},
        {"PartOfACone", "Cone .9 .4 200 ",
         turned(200,
                [](double v) {
                    return Place{.4 * (1 - v), 0, .9 * v};
                })},
        {"Hyperboloid", "Hyperboloid .4 -.1 -.4 .1 .3 .5 360 ",
         turned(360,
                [](double v) {
                    return Place{.4, -.1, -.4} * (1 - v) + Place{.1, .3, .5} * v;
                })},
        {"PartOfAHyperboloid", "Hyperboloid .4 -.1 -.4 .1 .3 .5 240 ",
         turned(240,
                [](double v) {
                    return Place{.4, -.1, -.4} * (1 - v) + Place{.1, .3, .5} * v;
                })},
        {"Paraboloid", "Paraboloid .5 0 .7 360 ",
         turned(360,
                [](double v) {
                    return Place{.5 * std::sqrt(v), 0, .7 * v};
                })},
        {"PartOfAParaboloid", "Paraboloid .5 .2 .7 300 ",
         turned(300,
                [](double v) {
                    const double z = mixed(.2, .7, v);
                    return Place{.5 * std::sqrt(z / .7), 0, z};
                })},
        {"Disk", "Disk .1 .5 360 ",
         turned(360,
                [](double v) {
                    return Place{.5 * (1 - v), 0, .1};
                })},
        {"PartOfADisk", "Disk -.1 .5 100 ",
         turned(100,
                [](double v) {
                    return Place{.5 * (1 - v), 0, -.1};
                })},
        {"Torus", "Torus .4 .15 0 360 360 ",
         turned(360, [](double v) { return on_circle(.4, .15, 360 * v); })},
        {"PartOfATorus", "Torus .4 .15 -60 200 270 ",
         turned(270, [](double v) { return on_circle(.4, .15, mixed(-60, 200, v)); })},
    };
}

/// Where the shape stands: turned, then moved to (x, y, z).
struct Stand {
    double degrees;
    Place axis, to;

    std::string rib() const {
        const auto text = [](const Place& p) {
            return std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' + std::to_string(p.z) + ' ';
        };
        return "Translate " + text(to) + "Rotate " + std::to_string(degrees) + ' ' + text(axis);
    }
    Place operator()(const Place& p) const {
        const Place k = axis * (1 / std::sqrt(axis.dot(axis)));
        const double c = std::cos(degrees * kDegree), s = std::sin(degrees * kDegree);
        return p * c + k.cross(p) * s + k * (k.dot(p) * (1 - c)) + to;
    }
};

/// So many cells along u and v: at the least distance, of about .5, the sum over their middles is off by the
/// square of a cell's part of that, some 2e-4.
constexpr int kCells = 128;

struct Cell {
    Place at, area;  ///< the middle; the area, along its normal
};

std::vector<Cell> cells_of(const LightForm& form, const Stand& stand) {
    std::vector<Cell> cells;
    const auto corner = [&](int i, int j) {
        return stand(form.surface(static_cast<double>(i) / kCells, static_cast<double>(j) / kCells));
    };
    for (int j = 0; j < kCells; ++j)
        for (int i = 0; i < kCells; ++i)
            cells.push_back(
                {stand(form.surface((i + 0.5) / kCells, (j + 0.5) / kCells)),
                 (corner(i + 1, j + 1) - corner(i, j)).cross(corner(i, j + 1) - corner(i + 1, j)) * 0.5});
    return cells;
}

/// What arrives at a point that is turned to -z from the outside of a shape, and from both sides.
struct Arriving {
    double outside = 0, both = 0;
};

Arriving arriving(const std::vector<Cell>& cells, const Place& P) {
    Arriving sum;
    double area = 0;
    for (const Cell& cell : cells) {
        const Place way = cell.at - P;
        const double distance2 = way.dot(way), shines = -cell.area.dot(way),
                     part = std::max(0.0, -way.z) * std::abs(shines) / (distance2 * distance2);
        sum.both += part, sum.outside += shines > 0 ? part : 0;
        area += std::sqrt(cell.area.dot(cell.area));
    }
    return {sum.outside / area, sum.both / area};
}

/// What one of a part's points found, what was expected, and what both sides would give.
struct Told {
    double found, expected, both;
};

/// Over a part of the picture the mean is within a hundredth of what both sides give. How points differ tells
/// what is left of noise: three deviations of the mean have to be within the hundredth, too, so that the test
/// can tell.
void expect_mean(const std::vector<Told>& part) {
    const auto count = static_cast<double>(part.size());
    double both = 0, error = 0, squares = 0;
    for (const Told& told : part) both += told.both / count;
    ASSERT_GT(both, 0);
    for (const Told& told : part) error += (told.found - told.expected) / both / count;
    for (const Told& told : part)
        squares += std::pow((told.found - told.expected) / both - error, 2) / (count - 1);
    EXPECT_NEAR(error, 0, 0.01);
    EXPECT_LT(3 * std::sqrt(squares / count), 0.01);
}

/// What points of the picture get of 1024 samples: red; green and blue are x and y of the point.
std::vector<Pixel> lit_points(const LightForm& form, const Stand& stand, const std::string& sides) {
    Case c = lit_by(
        "ShadingRate 16 AttributeBegin Attribute \"visibility\" \"int camera\" [0] "
        "Attribute \"light\" \"int nsamples\" [1024] " +
        sides + "AreaLightSource \"arealight\" \"a\" " + stand.rib() + form.rib +
        " AttributeEnd Illuminate \"a\" 1 ");
    return pixels(c.render("Ci = color(comp(diffuse(normal(0, 0, -1)), 0), xcomp(P), ycomp(P));"));
}

/// In each quarter of the picture, at 64 points.
void expect_integral(const LightForm& form, const Stand& stand) {
    const std::vector<Cell> cells = cells_of(form, stand);
    const std::vector<Pixel> both = lit_points(form, stand, ""),
                             outside = lit_points(form, stand, "Sides 1 ");
    ASSERT_EQ(both.size(), outside.size());
    std::vector<Told> of_both[4], of_outside[4];
    constexpr size_t kWidth = 64, kStep = 4;
    for (size_t y = kStep / 2; y < kWidth; y += kStep)
        for (size_t x = kStep / 2; x < kWidth; x += kStep) {
            const Pixel &p = both[y * kWidth + x], &q = outside[y * kWidth + x];
            const Arriving arrives =
                arriving(cells, {static_cast<double>(p.green), static_cast<double>(p.blue), 5});
            const size_t quarter = x * 2 / kWidth + y * 2 / kWidth * 2;
            of_both[quarter].push_back({static_cast<double>(p.red), arrives.both, arrives.both});
            of_outside[quarter].push_back({static_cast<double>(q.red), arrives.outside, arrives.both});
        }
    for (int quarter = 0; quarter < 4; ++quarter) {
        SCOPED_TRACE(stand.rib() + "quarter " + std::to_string(quarter));
        expect_mean(of_both[quarter]);
        SCOPED_TRACE("outside");
        expect_mean(of_outside[quarter]);
    }
}

class LightForms : public ::testing::TestWithParam<LightForm> {};

TEST_P(LightForms, GiveTheIntegralOverTheirShape) {
    expect_integral(GetParam(), {40, {1, 2, 3}, {.1, -.2, 3.5}});
    expect_integral(GetParam(), {50, {1, -1.5, .5}, {2, 1, 4.7}});
    expect_integral(GetParam(), {40, {1, 2, 3}, {10, -20, -95}});
}

INSTANTIATE_TEST_SUITE_P(, LightForms, ::testing::ValuesIn(light_forms()),
                         [](const ::testing::TestParamInfo<LightForm>& form) { return form.param.name; });

/// The square and the light's mesh are where the shader lifts them to, where rays meet them lifted.
TEST(AreaLights, ShineFromWhereTheyAreDisplacedTo) {
    const auto lifted = [](const std::string& displaced) {
        return "Attribute \"trace\" \"int displacements\" [" + displaced +
               "] Attribute \"displacementbound\" \"sphere\" [2] "
               "Displacement \"lift\" Polygon \"P\" [-.5 -.5 0 .5 -.5 0 .5 .5 0 -.5 .5 0] ";
    };
    const auto mesh = [](const std::string& shape) {
        return "AttributeBegin Attribute \"visibility\" \"int camera\" [0] Translate 0 0 3 "
               "Light \"PxrMeshLight\" \"m\" \"int fixedSampleCount\" [256] Scale 1 1 -1 " +
               shape + "AttributeEnd ";
    };
    const auto square_at = [](const std::string& z) {
        return "float expected = polygon(P, point(-.1, -.5, " + z + "), point(.9, -.5, " + z +
               "), point(.9, .5, " + z + "), point(-.1, .5, " + z + "));";
    };
    for (const auto& [light, expected] :
         {std::pair{arealight(lifted("1")), square_at("3.8") + "expected *= PI;"},
          {mesh(lifted("1")), square_at("2.2")},
          {arealight(lifted("0")), kUnitSquare + "expected *= PI;"},
          {mesh(lifted("0")), kUnitSquare}}) {
        Case c = lit_by(light);
        c.shaders["lift"] =
            "displacement lift() { P += vtransform(\"object\", \"current\", vector(.4, 0, .8));"
            "  N = calculatenormal(P); }";
        expect_lit(c.render(asks(expected)), 0.002, 0.03);
    }
}

}  // namespace
}  // namespace trapeze::testing
