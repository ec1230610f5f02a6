#include "sample/dualspace/sample_masks.h"

namespace trapeze {

/// For each pixel and axis, a row of kBins + 1 sets of its samples (64 a word): set b holds those whose bin
/// is below b, so that a range of bins is a difference of two sets. Axes are u, v, time; u and v are lens
/// coordinates or, without a lens, places in the pixel.
void SampleMasks::build(const SampleTile& samples, bool lens) {
    const auto per_pixel = static_cast<size_t>(samples.samples_per_pixel);
    const size_t pixels = static_cast<size_t>(samples.pixels.width()) * samples.pixels.height();
    words_ = (per_pixel + 63) / 64;
    masks_.assign(pixels * kAxes * (kBins + 1) * words_, 0);
    uint64_t* mask = masks_.data();
    size_t sample = 0;
    for (int py = samples.pixels.y0; py < samples.pixels.y1; ++py)
        for (int px = samples.pixels.x0; px < samples.pixels.x1; ++px) {
            for (size_t s = 0; s < per_pixel; ++s, ++sample) {
                const float u = lens ? lens_place(samples.lens_u[sample])
                                     : samples.x[sample] - static_cast<float>(px),
                            v = lens ? lens_place(samples.lens_v[sample])
                                     : samples.y[sample] - static_cast<float>(py);
                const float places[kAxes] = {u, v, samples.time[sample]};
                for (size_t axis = 0; axis < kAxes; ++axis) {
                    const size_t above = static_cast<size_t>(bin(places[axis])) + 1;
                    mask[(axis * (kBins + 1) + above) * words_ + s / 64] |= uint64_t{1} << (s % 64);
                }
            }
            // Samples were put one bin above their own; or-ing upwards makes of them the sets below each bin.
            for (int axis = 0; axis < kAxes; ++axis) {
                mask += words_;
                for (size_t i = 0; i < (kBins - 1) * words_; ++i) mask[words_ + i] |= mask[i];
                mask += kBins * words_;
            }
        }
}

}  // namespace trapeze
