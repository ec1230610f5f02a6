/// Scenes made by programs, for measurements that need a picture of any size: RIB as text, the same on every
/// machine and for every order of work.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trapeze {

/// What makes a scene larger, faster or more blurred than it is by itself.
struct SceneParameters {
    /// Multiplies the number of micropolygons: through the number of hairs or flowers in scenes of such,
    /// through ShadingRate in the others.
    double scale = 1;
    double motion = 1;        ///< multiplies the distances moved while the shutter is open; 0: nothing moves
    double defocus = 1;       ///< multiplies the lens; 0: a pinhole
    double shading_rate = 1;  ///< multiplies the scene's own
    int width = 1280, height = 720;
    /// Seconds, of scenes that are sequences (falling, bubbles, crocodile, hand, hair); the others are one
    /// moment.
    double time = 0;
};

/// The names that scene_text() knows. Here, since who lists them need not have the scenes.
inline std::vector<std::string_view> scene_names() {
    return {
#define TRAPEZE_SCENE(name, text) name,
#include "pipeline/study/scenes/scenes.def"
#undef TRAPEZE_SCENE
    };
}

/// The scene as RIB; empty for an unknown name. Numbers of `parameters` must be finite, scale positive, the
/// others not negative.
std::string scene_text(std::string_view name, const SceneParameters& parameters);

}  // namespace trapeze
