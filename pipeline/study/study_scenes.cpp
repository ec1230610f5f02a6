#include "pipeline/study/study_scenes.h"

namespace trapeze {

StudyScene car_scene(const StudyBench& bench) {
    return bench.scene("Car", "car-study", 3);
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

}  // namespace trapeze
