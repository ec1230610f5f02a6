#include "shade/check_looks.h"

#include "shade/imager.h"
#include "shade/maps/textures.h"
#include "shade/materials/material.h"
#include "shade/materials/named_maps.h"
#include "shade/take_aovs.h"

namespace trapeze {
void check_looks(const RenderContext& context, const MapIsMade& is_made, const Access& access) {
    const Scene& scene = *context.scene;
    Textures textures(scene.options, context.diagnostics, access);
    const Materials materials(context, access);
    const Imager imager(context, access);
    if (context.diagnostics)
        report_missing_aovs(aov_layout(scene.options), materials, scene.options, *context.diagnostics);

    const std::set<std::string> varied = variables_of(scene);
    std::vector<const BoundShader*> shaders = materials.shaders();
    if (imager.shader()) shaders.push_back(imager.shader());
    for (const BoundShader* shader : shaders)
        for (const NamedMap& map : named_maps(*shader, varied)) {
            if (is_made && is_made(map.name)) continue;
            textures.check(map.name, map.location, map.is_depths);
        }
}

}  // namespace trapeze
