#include "tests/fuzz/dice_text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "pipeline/rib/read_rib.h"
#include "tessellate/tessellate.h"

namespace trapeze::fuzz {
namespace {

/// Enough to come through every primitive of the input, little enough to do it often.
constexpr size_t kMostPrimitives = 40, kMostGrids = 200;

void dice(const Scene& scene, Diagnostics& diagnostics) {
    RenderContext context;
    context.scene = &scene;
    context.camera = make_camera(scene.options);
    context.motion = true;
    context.diagnostics = &diagnostics;
    const Tessellation tessellation(context);
    DiceScratch scratch;
    ShadingGrid grid;
    GridArena arena;
    const size_t count = tessellation.subpatches().size(), step = 1 + count / kMostGrids;
    for (size_t i = 0; i < count; i += step) {
        tessellation.dice(i, grid, scratch);
        grid.Ci = grid.Cs, grid.Oi = grid.Os;
        int64_t not_finite = 0;
        const Grid packed = pack_grid(grid, arena, &not_finite);
        for (int k = 0; k < packed.plane_count() * packed.shape.plane_size(); ++k)
            if (!std::isfinite(packed.positions[k])) std::abort();
    }
}

}  // namespace

void dice_world(const std::string& world) {
    Diagnostics diagnostics([](const Diagnostic&) {});
    ReadOptions options;
    options.shading_rate = 8;
    options.most_archives_read = 10;
    options.most_bytes_read = uint64_t{1} << 16;
    options.most_instanced_primitives = kMostPrimitives;
    int worlds = 0;
    read_rib_text(
        "Format 24 24 1 Projection \"perspective\" Shutter 0 1 Translate 0 0 4 WorldBegin\n" + world, "fuzz",
        options, diagnostics, [&](Scene&& scene) {
            scene.options.width = std::min(scene.options.width, 64);
            scene.options.height = std::min(scene.options.height, 64);
            if (scene.primitives.size() > kMostPrimitives) scene.primitives.resize(kMostPrimitives);
            if (++worlds <= 2) dice(scene, diagnostics);
        });
}

}  // namespace trapeze::fuzz
