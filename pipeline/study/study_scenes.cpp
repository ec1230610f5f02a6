#include "pipeline/study/study_scenes.h"

#include "pipeline/study/paper_figures.h"

namespace trapeze {
namespace {

/// That make the scenes as large as the paper's; the furballs' scale makes 495,000 hairs.
constexpr double kFurballsRate = 2, kFlowersScale = 12.9, kHalberdScale = 7.1, kCarsScale = 28.4;

}  // namespace

StudyScene car_scene(const StudyBench& bench) {
    return bench.scene("Car", "car-study", 3);
}

StudyScene car_scene_with(const StudyBench& bench, bool motion, bool defocus) {
    StudyScene scene = car_scene(bench);
    if (!motion) scene.parameters.motion = 0;
    if (!defocus) scene.parameters.defocus = 0;
    scene.label += !motion ? ", defocus" : !defocus ? ", motion blur" : ", both";
    return scene;
}

StudyScene halberd_scene(const StudyBench& bench) {
    return bench.scene("Halberd", "halberd", 1);
}

std::array<StudyScene, 4> scenes_of_the_paper(const StudyBench& bench) {
    std::array<StudyScene, 4> scenes = {bench.scene("Furball", "hair", 3),
                                        bench.scene("Ladybug", "flowers", 3),
                                        bench.scene("Fairy", "halberd", 6), car_scene(bench)};
    scenes[0].parameters.motion = scenes[1].parameters.motion = 0;
    return scenes;
}

std::array<StudyScene, 4> frames_of_the_paper(const StudyBench& bench) {
    std::array<StudyScene, 4> frames;
    constexpr struct {
        const char* name;
        double scale, shading_rate;
        bool moves;
    } kFrames[] = {{"furballs", 5, kFurballsRate, false},
                   {"flowers", kFlowersScale, 1, false},
                   {"halberd", kHalberdScale, 1, true},
                   {"car-study", kCarsScale, 1, true}};
    for (size_t i = 0; i < frames.size(); ++i) {
        StudyScene& frame = frames[i];
        frame.label = paper::kScenes[i], frame.name = kFrames[i].name;
        SceneParameters& p = frame.parameters;
        p.scale = kFrames[i].scale, p.shading_rate = kFrames[i].shading_rate;
        p.motion = kFrames[i].moves ? 1 : 0;
        p.height = paper::kHeight[i];
        if (!bench.quick()) continue;
        p.width /= 4, p.height /= 4;
        // Where ShadingRate makes the micropolygons, fewer pixels have fewer; hairs and flowers are counted.
        if (i < 2) p.scale /= 16;
    }
    return frames;
}

}  // namespace trapeze
