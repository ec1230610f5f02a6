#include "pipeline/study/scenes/scenes.h"

#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze {
namespace {

struct SceneRow {
    std::string_view name;
    std::string (*text)(const SceneParameters&);
};

constexpr SceneRow kScenes[] = {
#define TRAPEZE_SCENE(name, text) {name, scenes::text},
#include "pipeline/study/scenes/scenes.def"
#undef TRAPEZE_SCENE
};

}  // namespace

std::string scene_text(std::string_view name, const SceneParameters& parameters) {
    for (const SceneRow& row : kScenes)
        if (row.name == name) return row.text(parameters);
    return {};
}

}  // namespace trapeze
