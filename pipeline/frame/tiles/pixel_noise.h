/// How noisy a pixel is: what more samples of it would gain.
#pragma once

#include <cstddef>

#include "sample/patterns/sample_levels.h"

namespace trapeze {

/// What tells the samples of a picture apart.
struct SampleDomains {
    bool lens = false, motion = false;
};

/// Noise of two kinds, which add up.
struct PixelNoise {
    float sharp = 0;    ///< of what changes within pixels: the next pixel may have none of it
    float blurred = 0;  ///< of what the lens and the shutter spread over many pixels, which then have it, too

    float sum() const { return sharp + blurred; }
};

/// The variance that a sample of a pixel adds to the mean of many, of linear colours and alpha, the mean over
/// the four channels. `rgba` are `count` samples of a first level, four numbers each, `times` their times.
///
/// The samples are stratified in the pixel, on the lens and in time. What changes along one of these alone is
/// seen evenly by all its regions and makes no noise; only what is left does (the main effects of Latin
/// hypercubes, [Stein87]). How much changes along each is what neighbours in it do not differ by: neighbours
/// in the pixel are alike where an edge is sharp, neighbours on the lens where something is out of focus,
/// neighbours in time where it moves.
PixelNoise pixel_noise(const float* rgba, const float* times, size_t count,
                       const SampleLevels::Neighbours& neighbours, SampleDomains domains);

}  // namespace trapeze
