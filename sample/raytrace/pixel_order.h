/// The order in which rays are traced pixel by pixel.
#pragma once

#include <cstdint>

#include "core/samples.h"
#include "core/z_order.h"

namespace trapeze {

/// Calls visit(first) with the first sample of each pixel, along the Z-order curve over a tile's rectangle;
/// of a list in the order that it has.
template <class Visit>
void for_each_first_sample(const SampleTile& samples, const Visit& visit) {
    if (samples.is_list()) {
        for (size_t pixel = 0; pixel < samples.listed.size(); ++pixel)
            visit(static_cast<uint32_t>(pixel * static_cast<size_t>(samples.samples_per_pixel)));
        return;
    }
    for_each_in_z_order(samples.pixels,
                        [&](int x, int y) { visit(static_cast<uint32_t>(samples.first_of_pixel(x, y))); });
}

}  // namespace trapeze
