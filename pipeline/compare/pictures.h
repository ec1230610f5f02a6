/// What methods make of a shared frame: pictures, what they cost pixel by pixel, and how far they are from a
/// reference of many samples.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "composite/image.h"
#include "pipeline/compare/shared_frame.h"
#include "pipeline/frame/tiles/resolve_tiles.h"
#include "sample/visibility.h"

namespace trapeze {

/// A picture and where its samples were costly.
struct MethodPicture {
    Image image;
    HeatMap heat;  ///< of the picture's pixels
    /// The most memory that was taken while the method was prepared; nothing where that is not known.
    std::optional<size_t> build_peak_bytes = {};
};

/// Renders the frame as a method sees it at a sample rate, or with adaptive samples for a `variance` above 0,
/// with the threads of the calling task arena. Empty when cancelled. `on_progress` gets the part done in [0,
/// 1], from any thread, one call at a time.
std::optional<MethodPicture> make_picture(const SharedFrame& frame, const Sampler& sampler, SampleRate rate,
                                          const std::function<void(double)>& on_progress = {},
                                          float variance = 0);

/// Renders the frame with side x side stratified samples a pixel, which are other samples than any that
/// make_picture() takes. Empty when cancelled.
std::optional<Image> make_reference(const SharedFrame& frame, int side,
                                    const std::function<void(double)>& on_progress = {});

/// Root of the mean squared difference of red, green and blue over all pixels of two images of the same
/// window.
double rms_difference(const Image& a, const Image& b);

}  // namespace trapeze
