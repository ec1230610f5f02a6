/// For this room's tests: a scene of one primitive, a small grid of it, and the door opened on both.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "shade/shading.h"

namespace trapeze::testing {

inline Parameter number(std::string name, float value) {
    return {std::move(name), {StorageClass::Uniform, ValueType::Float, 1}, {value}, {}};
}
inline Parameter triple(std::string name, ValueType type, const V3f& v) {
    return {std::move(name), {StorageClass::Uniform, type, 1}, {v.x, v.y, v.z}, {}};
}
inline Parameter color(std::string name, const V3f& v) {
    return triple(std::move(name), ValueType::Color, v);
}
inline Parameter point(std::string name, const V3f& v) {
    return triple(std::move(name), ValueType::Point, v);
}
inline Parameter text(std::string name, std::string value) {
    return {std::move(name), {StorageClass::Uniform, ValueType::String, 1}, {}, {std::move(value)}};
}
inline ShaderInstance shader(std::string name, std::vector<Parameter> parameters = {}) {
    ShaderInstance instance;
    instance.name = std::move(name);
    instance.parameters.values = std::move(parameters);
    return instance;
}

struct ShadingScene {
    Scene scene;
    RenderContext context;
    std::vector<Diagnostic> reported;
    Diagnostics diagnostics{[this](const Diagnostic& d) { reported.push_back(d); }};
    std::shared_ptr<Attributes> attributes = std::make_shared<Attributes>();

    ShadingScene() {
        scene.primitives.resize(1);
        scene.primitives[0].attributes = attributes;
        scene.primitives[0].camera_from_object = {M44f()};
        context.scene = &scene;
        context.diagnostics = &diagnostics;
        // Pixels smaller than the micropolygons of small grids.
        context.camera.plane_scale_x = 1e-3f, context.camera.plane_scale_y = -1e-3f;
    }
    ShadingScene(const ShadingScene&) = delete;

    void surface(std::string name, std::vector<Parameter> parameters = {}) {
        attributes->surface =
            std::make_shared<ShaderInstance>(shader(std::move(name), std::move(parameters)));
    }
    ShaderInstance& displacement(std::string name, std::vector<Parameter> parameters = {}) {
        const auto made = std::make_shared<ShaderInstance>(shader(std::move(name), std::move(parameters)));
        attributes->displacement = made;
        return *made;
    }
    ShaderInstance& light(std::string name, std::vector<Parameter> parameters = {}) {
        auto made = std::make_shared<LightInstance>();
        made->shader = shader(std::move(name), std::move(parameters));
        attributes->lights.push_back(made);
        return made->shader;
    }

    /// The primitive has a variable, of which grids bring the values.
    void declare(std::string name, Declaration declaration) {
        auto shape = std::make_shared<Shape>();
        shape->variables.values.push_back({std::move(name), declaration, {}, {}});
        scene.primitives[0].shape_keys = {shape};
    }

    /// nu x nv micropolygons on the plane z = 4 over x, y, s, t in 0..1, v and t running down (y = 1 - v);
    /// dPdu x dPdv and N are towards the eye.
    ShadingGrid grid(int nu = 3, int nv = 2, int keys = 1) const {
        ShadingGrid grid;
        grid.shape = {static_cast<uint8_t>(nu), static_cast<uint8_t>(nv)};
        grid.key_count = keys;
        grid.primitive = &scene.primitives[0];
        const size_t count = grid.vertex_count();
        grid.P.resize(keys);
        for (auto* plane : {&grid.u, &grid.v, &grid.s, &grid.t}) plane->resize(count);
        for (auto& P : grid.P) P.resize(count);
        for (int j = 0; j <= nv; ++j)
            for (int i = 0; i <= nu; ++i) {
                const size_t at = grid.shape.row_index(i, j);
                grid.u[at] = grid.s[at] = static_cast<float>(i) / static_cast<float>(nu);
                grid.v[at] = grid.t[at] = static_cast<float>(j) / static_cast<float>(nv);
                for (auto& P : grid.P) P.set(at, V3f(grid.u[at], 1 - grid.v[at], 4));
            }
        grid.N.fill(count, V3f(0, 0, -1)), grid.Ng = grid.N;
        grid.dPdu.fill(count, V3f(1, 0, 0)), grid.dPdv.fill(count, V3f(0, -1, 0));
        grid.reverse_orientation = false;
        grid.Cs.fill(count, V3f(0.8f, 0.4f, 0.2f));
        grid.Os.fill(count, V3f(1, 0.5f, 0.25f));
        return grid;
    }

    ShadingGrid shaded(ShadingGrid grid) const {
        const Shading shading(context);
        ShadeScratch scratch;
        ShadeStats stats;
        shading.shade(grid, scratch, stats);
        EXPECT_EQ(stats.shaded_vertices, grid.vertex_count());
        shading.report_displacement_bounds();
        return grid;
    }
    ShadingGrid shaded() const { return shaded(grid()); }
};

inline void expect_near_triple(const V3f& a, const V3f& b, float tolerance, const char* what = "") {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << what << " component " << k;
}

inline bool finite(const Triples& values) {
    for (const std::vector<float>& plane : values.c)
        for (float x : plane)
            if (!std::isfinite(x)) return false;
    return true;
}

}  // namespace trapeze::testing
