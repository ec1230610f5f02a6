/// For tests: scenes of one primitive, diced into grids.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "core/scene/camera.h"
#include "core/scene/scene.h"
#include "tessellate/tessellate.h"
#include "tessellate/topology/surface.h"

namespace trapeze::testing {

inline M44f translation(float x, float y, float z) {
    M44f m;
    m.setTranslation(V3f(x, y, z));
    return m;
}

/// A shape as parsing would make it, without checks.
inline std::shared_ptr<const Shape> shape_of(Topology topology, ParameterList variables = {}) {
    return std::make_shared<const Shape>(Shape{std::move(topology), std::move(variables)});
}

inline Topology quadric(Quadric::Kind kind, std::initializer_list<float> values) {
    Quadric q;
    q.kind = kind;
    std::copy(values.begin(), values.end(), q.values.begin());
    q.value_count = static_cast<int>(values.size());
    return q;
}

inline Parameter parameter(std::string name, StorageClass storage, ValueType type,
                           std::vector<float> floats) {
    return {std::move(name), {storage, type, 1}, std::move(floats), {}};
}

/// A primitive, its attributes still open to change, and the options of its camera.
struct TestScene {
    Scene scene;
    std::shared_ptr<Attributes> attributes = std::make_shared<Attributes>();
    Diagnostics diagnostics;

    TestScene() {
        scene.options.projection = "perspective";
        scene.options.width = 96, scene.options.height = 72;
        scene.options.near_clip = 1e-3f;
    }
    TestScene& add(ShapeKeys shapes, std::vector<M44f> camera_from_object) {
        Primitive primitive;
        primitive.attributes = attributes;
        primitive.shape_keys = std::move(shapes);
        primitive.camera_from_object = camera_from_object;
        scene.primitives.push_back(std::move(primitive));
        return *this;
    }
    TestScene& add(std::shared_ptr<const Shape> shape,
                   const M44f& camera_from_object = translation(0, 0, 5)) {
        return add(std::vector{std::move(shape)}, std::vector{camera_from_object});
    }
    TessellationOptions::OfPrimitive is_displaced;

    /// Nothing is culled: displacement could bring it into view.
    TestScene& keep_all() {
        attributes->displacement_bound = 1e4f;
        return *this;
    }
    /// Refers to this scene and its diagnostics. Motion is on.
    RenderContext context() {
        RenderContext context;
        context.scene = &scene;
        context.camera = make_camera(scene.options);
        context.motion = true;
        context.diagnostics = &diagnostics;
        return context;
    }
};

/// All subpatches as packed grids, after a displacement where there is one.
struct DicedScene {
    using Displace = std::function<void(ShadingGrid&)>;

    std::vector<Grid> grids;
    GridArena arena;
    TessellateStats stats;

    explicit DicedScene(TestScene& test, const Displace& displace = {}) {
        const RenderContext context = test.context();
        TessellationOptions options;
        options.is_displaced = test.is_displaced;
        const Tessellation tessellation(context, options);
        stats = tessellation.stats();
        DiceScratch scratch;
        ShadingGrid grid;
        for (size_t i = 0; i < tessellation.subpatches().size(); ++i) {
            tessellation.dice(i, grid, scratch);
            if (displace) displace(grid);
            grid.Ci = grid.Cs, grid.Oi = grid.Os;
            int64_t not_finite = 0;
            grids.push_back(pack_grid(grid, arena, &not_finite));
            bad_values += not_finite;
        }
    }
    /// Values that were no numbers when grids were packed.
    int64_t bad_values = 0;
};

}  // namespace trapeze::testing
