/// How different two pictures look to somebody who sees them in turns on one screen: LDR-FLIP [Andersson20].
/// The mean squared error counts values; this counts what an observer would notice, at the distance from
/// which a degree has 67 pixels (a screen .7 m wide of 3840 pixels, from .7 m).
#pragma once

#include <vector>

#include "composite/image.h"

namespace trapeze {

/// A picture as an eye takes it in: planes of its window's pixels.
struct SeenPicture {
    int width = 0, height = 0;
    /// Filtered as contrast sensitivity filters: L*, and a* and b* that count less where it is dark (Hunt).
    std::vector<float> lightness, a, b;
    std::vector<float> edges, points;  ///< how much of an edge or a point is there
};

/// Of what a screen shows: linear values clipped at black and white. What is no number is black.
SeenPicture seen_picture(const Image& image);

/// The difference of each pixel, from 0 (the same) to 1 (as green to blue). The pictures have the same size.
std::vector<float> flip_differences(const SeenPicture& picture, const SeenPicture& reference);

/// The mean of these. The same bits with any number of threads and on every machine.
double flip_difference(const SeenPicture& picture, const SeenPicture& reference);

}  // namespace trapeze
