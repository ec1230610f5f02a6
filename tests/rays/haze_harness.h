/// Scenes with a haze that rays go through.
#pragma once

#include <string>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {

/// A chord is that of micropolygons: shorter by up to 1e-3, and where they lie inside of a thin part.
inline constexpr float kThinChord = 2e-3f;

/// Volume "haze": what is behind shines through as the exponential of the way says (Beer and Lambert); the
/// rest is its own colour. Surface "on" sends rays straight on.
inline Case hazy() {
    Case c;
    c.shaders["haze"] =
        "volume haze(float k = .5; color own = 0) { float t = exp(-k * length(I));"
        " Ci = mix(own, Ci, t); Oi = mix(color 1, Oi, t); }";
    c.shaders["on"] = "surface on() { Ci = trace(P, I); Oi = 1; }";
    return c;
}

}  // namespace trapeze::testing
