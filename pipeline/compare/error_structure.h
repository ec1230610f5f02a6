/// How far a picture is from a reference, and whether neighbouring pixels err alike: noise that pixels have
/// on their own averages out over a few of them, aliasing and patterns do not.
#pragma once

#include "composite/image.h"

namespace trapeze {

struct PictureError {
    double rmse = 0;  ///< as rms_difference()
    /// Pixels that err as one: how many times the mean squared error of means over blocks is what it would be
    /// were every pixel's error its own. 1 of such noise (more where a filter is wider than a pixel), up to
    /// the pixels of a block where all of it errs alike; 0 of no error. Patterns whose error changes its sign
    /// within a block, regularly, come to less than 1.
    double pixels_together = 0;
};

/// The error of an image against a reference of the same window, and its structure in blocks of `block` x
/// `block` pixels from the window's corner, which are smaller at the right and lower borders.
PictureError picture_error(const Image& image, const Image& reference, int block);

/// The image with every block's pixels replaced by their mean: its differences are those that do not average
/// out.
Image block_means(const Image& image, int block);

}  // namespace trapeze
