/// Rays that ask whether something is near what the camera sees, for comparisons of trees: incoherent ones,
/// as shaders send them.
#pragma once

#include <vector>

#include "core/rays.h"
#include "pipeline/compare/shared_frame.h"

namespace trapeze {

/// Where hits of occlusion rays count: anywhere before them.
inline constexpr DepthRange kOcclusionRange{};

/// One ray for each sample that sees something, from there, at its time, in a random direction of the half
/// that the camera is in; it starts a thousandth of the distance off. In the order of the samples, and the
/// same for any number of threads. At most `sample_bytes` of samples are held at a time. Empty when
/// cancelled. Source: [Gruenschloss11] sec. 5, one primary and one occlusion ray a sample.
std::vector<SpaceRay> occlusion_rays(const SharedFrame& frame, SampleRate rate, size_t sample_bytes);

}  // namespace trapeze
