/// A sample of a deep picture.
#pragma once

namespace trapeze {

/// A surface at a depth, with its own premultiplied colour and alpha: over what is behind it, as compositing
/// programs put samples of a deep picture together.
struct DeepSample {
    float depth = 0;  ///< camera-space
    float rgba[4] = {0, 0, 0, 0};

    bool operator==(const DeepSample&) const = default;
};

}  // namespace trapeze
