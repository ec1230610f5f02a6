#include "pipeline/study/scenes/scenes.h"

#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze {
namespace {

struct SceneRow {
    std::string_view name;
    std::string (*text)(const SceneParameters&);
};

constexpr SceneRow kScenes[] = {
    {"hair", scenes::hair_scene},         {"furball", scenes::furball_scene},
    {"furballs", scenes::furballs_scene}, {"halberd", scenes::halberd_scene},
    {"flowers", scenes::flowers_scene},   {"car-study", scenes::car_study_scene},
    {"arcade", scenes::arcade_scene},     {"falling", scenes::falling_scene},
};

}  // namespace

std::vector<std::string_view> scene_names() {
    std::vector<std::string_view> names;
    for (const SceneRow& row : kScenes) names.push_back(row.name);
    return names;
}

std::string scene_text(std::string_view name, const SceneParameters& parameters) {
    for (const SceneRow& row : kScenes)
        if (row.name == name) return row.text(parameters);
    return {};
}

}  // namespace trapeze
