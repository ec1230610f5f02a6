/// Frames of BART's animations as trees follow them: what the report on dynamic updates measures
/// [DynBvh06 table 1].
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/scene/scene.h"
#include "pipeline/study/sequence.h"

namespace trapeze {

struct BartScene {
    const char *label, *file;  ///< below the folder of the scenes
    int width, height;         ///< of the report's pictures
    const paper::SequenceClaims& report;
};
/// The report has the museum with some 65,000 moving triangles, which nobody offers any more; here are 1,024.
inline constexpr BartScene kBartScenes[] = {
    {"Kitchen", "kitchen/aff/kitchen.aff", 300, 225, paper::kKitchen},
    {"Museum", "museum/aff/museum5.aff", 800, 640, paper::kMuseum},
};

/// Frames, with all that the sequence refers to.
struct BartFrames {
    std::unique_ptr<const Scene> scene;
    RenderContext context;
    std::vector<Grids> grids;
    Sequence sequence;
};

/// Frames that follow one another, from the middle of the animation, seen from where its camera is then: in
/// camera space nothing else would stand still. Each triangle is a grid of one micropolygon. Empty, and in
/// the notes why, where a file cannot be read.
std::unique_ptr<BartFrames> bart_frames(StudyBench& bench, const BartScene& scene, StudyResult& result);

}  // namespace trapeze
