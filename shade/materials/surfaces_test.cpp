#include <algorithm>
#include <cmath>
#include <functional>

#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::color;
using testing::expect_near_triple;
using testing::finite;
using testing::number;
using testing::point;
using testing::ShadingScene;

const V3f kCs(0.8f, 0.4f, 0.2f), kOs(1, 0.5f, 0.25f);  // of the test grid

/// RISpec's formulas in doubles for one vertex of the test grid, under an ambient light of 0.1 and a point
/// light of 20 at kLamp.
const V3f kLamp(-1, 3, 0);

struct Reference {
    V3d N, V, L;
    double ambient = 0.1, lamp = 0;

    explicit Reference(const V3f& P) {
        const V3d toward(kLamp - P);
        N = V3d(0, 0, -1), V = -V3d(P).normalized(), L = toward.normalized();
        lamp = 20 / toward.dot(toward);
    }
    double diffuse() const { return lamp * std::max(0.0, N.dot(L)); }
    double specular(double roughness) const {
        return lamp * std::pow(std::max(0.0, N.dot((L + V).normalized())), 8 / roughness);
    }
};

void light(ShadingScene& scene) {
    scene.light("ambientlight", {number("intensity", 0.1f)});
    scene.light("pointlight", {number("intensity", 20), point("from", kLamp)});
}

/// Every vertex of the shaded grid against a formula for Ci / Os.
void expect_colors(const ShadingGrid& grid, const std::function<V3f(const Reference&)>& formula) {
    for (size_t i = 0; i < grid.vertex_count(); ++i) {
        const V3f expected = kOs * formula(Reference(grid.P[0].at(i)));
        expect_near_triple(grid.Ci.at(i), expected, 3e-6f * (1 + expected.length()));
        EXPECT_EQ(grid.Oi.at(i), kOs);
    }
}

V3f grey(double x) {
    return V3f(static_cast<float>(x));
}

TEST(Surfaces, Constant) {
    ShadingScene scene;
    scene.surface("constant");
    light(scene);
    expect_colors(scene.shaded(), [](const Reference&) { return kCs; });
}

TEST(Surfaces, Matte) {
    ShadingScene scene;
    light(scene);
    scene.surface("matte");
    expect_colors(scene.shaded(), [](const Reference& r) { return kCs * grey(r.ambient + r.diffuse()); });
    scene.surface("matte", {number("Ka", 0.5f), number("Kd", 0.25f)});
    expect_colors(scene.shaded(),
                  [](const Reference& r) { return kCs * grey(0.5 * r.ambient + 0.25 * r.diffuse()); });
}

TEST(Surfaces, Metal) {
    ShadingScene scene;
    light(scene);
    for (const char* name : {"metal", "shinymetal"}) {
        scene.surface(name);
        expect_colors(scene.shaded(),
                      [](const Reference& r) { return kCs * grey(r.ambient + r.specular(0.1)); });
    }
    scene.surface("metal", {number("Ka", 2), number("Ks", 0.5f), number("roughness", 0.3f)});
    expect_colors(scene.shaded(),
                  [](const Reference& r) { return kCs * grey(2 * r.ambient + 0.5 * r.specular(0.3f)); });
}

TEST(Surfaces, Plastic) {
    ShadingScene scene;
    light(scene);
    scene.surface("plastic");
    expect_colors(scene.shaded(), [](const Reference& r) {
        return kCs * grey(r.ambient + 0.5 * r.diffuse()) + grey(0.5 * r.specular(0.1));
    });
    const V3f tint(1, 0.5f, 0.1f);
    scene.surface("plastic", {number("Ka", 0), number("Kd", 0.3f), number("Ks", 0.9f),
                              number("roughness", 0.05f), color("specularcolor", tint)});
    expect_colors(scene.shaded(), [&](const Reference& r) {
        return kCs * grey(0.3f * r.diffuse()) + tint * grey(0.9f * r.specular(0.05f));
    });
}

TEST(Surfaces, PaintedPlasticWithoutATextureIsPlastic) {
    ShadingScene scene;
    light(scene);
    scene.surface("plastic");
    const ShadingGrid plastic = scene.shaded();
    scene.surface("paintedplastic");
    EXPECT_EQ(scene.shaded().Ci.c, plastic.Ci.c);
    EXPECT_TRUE(scene.reported.empty());
}

TEST(Surfaces, DefaultsurfaceIsLitFromTheEyeAlone) {
    ShadingScene scene;
    light(scene);
    const ShadingGrid unnamed = scene.shaded();
    expect_colors(unnamed, [](const Reference& r) {
        const double cosine = r.N.dot(r.V);
        return kCs * grey(0.2 + 0.8 * cosine * cosine);
    });
    for (const char* name : {"defaultsurface", "default"}) {
        scene.surface(name);
        EXPECT_EQ(scene.shaded().Ci.c, unnamed.Ci.c);
    }
    EXPECT_TRUE(scene.reported.empty());
}

/// Passes that make depth maps use it: it hides what is behind it.
TEST(Surfaces, NullHasItsOwnColourAndOpacity) {
    ShadingScene scene;
    light(scene);
    scene.surface("null");
    const ShadingGrid grid = scene.shaded();
    for (size_t i = 0; i < grid.vertex_count(); ++i) {
        EXPECT_EQ(grid.Ci.at(i), scene.grid().Cs.at(i) * scene.grid().Os.at(i));
        EXPECT_EQ(grid.Oi.at(i), scene.grid().Os.at(i));
    }
}

TEST(Surfaces, NormalsAwayFromTheEyeAreTurned) {
    ShadingScene scene;
    light(scene);
    scene.surface("plastic");
    const ShadingGrid front = scene.shaded();
    ShadingGrid turned = scene.grid();
    turned.N.fill(turned.vertex_count(), V3f(0, 0, 1));
    turned.Ng = turned.N;
    EXPECT_EQ(scene.shaded(turned).Ci.c, front.Ci.c);
}

TEST(Surfaces, LightsBehindAreNotSeen) {
    ShadingScene scene;
    scene.surface("plastic");
    scene.light("pointlight", {number("intensity", 1000), point("from", V3f(0, 0, 9))});
    const ShadingGrid grid = scene.shaded();
    for (size_t i = 0; i < grid.vertex_count(); ++i) EXPECT_EQ(grid.Ci.at(i), V3f(0));
}

TEST(Surfaces, LightsAdd) {
    ShadingScene scene;
    scene.surface("matte");
    scene.light("distantlight");
    const V3f one = scene.shaded().Ci.at(3);
    scene.light("distantlight", {number("intensity", 0.5f)});
    expect_near_triple(scene.shaded().Ci.at(3), one * 1.5f, 1e-6f);
}

TEST(Surfaces, OrthographicViewsLookAlongZ) {
    ShadingScene scene;
    scene.context.camera.perspective = false;
    const ShadingGrid grid = scene.shaded();
    for (size_t i = 0; i < grid.vertex_count(); ++i) expect_near_triple(grid.Ci.at(i), kOs * kCs, 1e-6f);
}

GridVariable variable(std::string name, Declaration declaration, std::vector<std::vector<float>> planes,
                      bool uniform) {
    GridVariable made;
    made.name = std::move(name), made.declaration = declaration;
    made.planes = std::move(planes), made.uniform = uniform;
    return made;
}

TEST(PrimitiveVariables, ReplaceParameters) {
    ShadingScene scene;
    scene.light("distantlight");
    scene.surface("matte", {number("Kd", 1)});
    const V3f full = scene.shaded().Ci.at(0);
    ShadingGrid grid = scene.grid();
    std::vector<float> Kd(grid.vertex_count());
    for (size_t i = 0; i < Kd.size(); ++i) Kd[i] = 0.1f * static_cast<float>(i);
    scene.declare("Kd", {StorageClass::Vertex, ValueType::Float, 1});
    grid.variables.push_back(variable("Kd", {StorageClass::Vertex, ValueType::Float, 1}, {Kd}, false));
    const ShadingGrid varying = scene.shaded(grid);
    for (size_t i = 0; i < Kd.size(); ++i) expect_near_triple(varying.Ci.at(i), full * Kd[i], 1e-6f);

    grid.variables[0] = variable("Kd", {StorageClass::Constant, ValueType::Float, 1}, {{0.5f}}, true);
    const ShadingGrid constant = scene.shaded(grid);
    for (size_t i = 0; i < Kd.size(); ++i) expect_near_triple(constant.Ci.at(i), full * 0.5f, 1e-6f);
}

TEST(PrimitiveVariables, ReplaceColors) {
    ShadingScene scene;
    light(scene);
    const V3f tint(0.2f, 0.9f, 0.4f);
    scene.surface("plastic", {color("specularcolor", tint)});
    const ShadingGrid expected = scene.shaded();
    scene.surface("plastic");
    ShadingGrid grid = scene.grid();
    const size_t n = grid.vertex_count();
    scene.declare("specularcolor", {StorageClass::Varying, ValueType::Color, 1});
    grid.variables.push_back(variable(
        "specularcolor", {StorageClass::Varying, ValueType::Color, 1},
        {std::vector<float>(n, tint.x), std::vector<float>(n, tint.y), std::vector<float>(n, tint.z)},
        false));
    EXPECT_EQ(scene.shaded(grid).Ci.c, expected.Ci.c);
}

TEST(PrimitiveVariables, OfAnotherTypeDoNot) {
    ShadingScene scene;
    light(scene);
    scene.surface("matte");
    ShadingGrid grid = scene.grid();
    grid.variables.push_back(
        variable("Kd", {StorageClass::Constant, ValueType::Color, 1}, {{0}, {0}, {0}}, true));
    EXPECT_EQ(scene.shaded(grid).Ci.c, scene.shaded().Ci.c);
}

TEST(Surfaces, DegenerateInputGivesFiniteColors) {
    for (const char* name : {"constant", "matte", "plastic", "metal", "paintedplastic", "defaultsurface"}) {
        ShadingScene scene;
        scene.surface(name);
        if (std::string(name) == "plastic" || std::string(name) == "metal")
            scene.surface(name, {number("roughness", 0)});
        light(scene);
        scene.light("spotlight", {point("to", V3f(0))});
        scene.light("distantlight", {point("to", V3f(0))});
        ShadingGrid grid = scene.grid();
        grid.N.fill(grid.vertex_count(), V3f(0));
        grid.P[0].set(0, V3f(0));
        grid.P[0].set(1, kLamp);
        grid.P[0].set(2, V3f(1e30f));
        grid.N.set(2, V3f(1e-30f));
        grid.N.set(3, V3f(0, 0, 1e25f));
        const ShadingGrid shaded = scene.shaded(grid);
        EXPECT_TRUE(finite(shaded.Ci) && finite(shaded.Oi)) << name;
    }
}

}  // namespace
}  // namespace trapeze
