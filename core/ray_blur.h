/// Which blurs a picture has, for what takes less work without one of them.
#pragma once

namespace trapeze {

/// What tells rays of a pixel apart, besides their places in it. Templates take both flags in this order, as
/// kMotion and kLens.
struct RayBlur {
    bool motion = false;  ///< their times
    bool lens = false;    ///< where they start
};

}  // namespace trapeze
