/// What the naive way to clip what moves loses: pictures with the pixels marked that are not as they should
/// be [Gruenschloss11 figure 3].
#pragma once

#include <cstddef>
#include <string>

#include "composite/image.h"
#include "pipeline/study/study_result.h"

namespace trapeze {

/// Pixels whose colours are not the same in two images of the same window.
size_t pixels_that_differ(const Image& a, const Image& b);

/// A picture beside the same one with hits lost, and that one again with its wrong pixels in red.
StudyCloseUps pictures_of_lost_hits(const std::string& scene, const Image& right, const Image& wrong);

}  // namespace trapeze
