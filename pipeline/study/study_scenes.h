/// Which of our scenes stand for the paper's.
#pragma once

#include <array>

#include "pipeline/study/study_bench.h"

namespace trapeze {

/// Our four scenes in the order of paper::kScenes: hair for Furball and flowers for Ladybug, both still and
/// out of focus as there; the halberd for Fairy, cars for Car, moving and out of focus. About five
/// micropolygons a pixel.
std::array<StudyScene, 4> scenes_of_the_paper(const StudyBench& bench);

/// Our four scenes as large as the paper's are, to within some percent, in the order of paper::kScenes and at
/// their sizes: transparent fur on a mirror, flowers, the halberd, cars. A sixteenth where the bench is
/// quick.
std::array<StudyScene, 4> frames_of_the_paper(const StudyBench& bench);

/// The counterpart of Car, with five or more micropolygons a pixel.
StudyScene car_scene(const StudyBench& bench);
/// The same with one of its effects or both, named so ("Car, both").
StudyScene car_scene_with(const StudyBench& bench, bool motion, bool defocus);
/// The scene of the controlled study [Hou10 figure 8].
StudyScene halberd_scene(const StudyBench& bench);

}  // namespace trapeze
