/// Plants of bicubic patches as retained objects, each with its root at the origin, upright along y, about
/// one unit high; flowers look towards -z.
#pragma once

#include <cstdint>

#include "pipeline/study/scenes/rib_writer.h"

namespace trapeze::scenes {

/// Kinds of flowers, and how many different plants there are of each kind and of tufts of grass.
inline constexpr uint32_t kFlowerKinds = 5, kFlowerVariants = 4, kTuftVariants = 6;

/// Indices into the flowers' kinds.
enum FlowerKind : uint32_t { kPoppy, kDaisy, kCornflower, kTulip, kCosmos };

/// Handles of the objects that write_plant_objects() has defined.
int flower_object(uint32_t kind, uint32_t variant);
int tuft_object(uint32_t variant);
int ladybug_daisy_object();  ///< a daisy with a ladybug on it

/// Defines all objects; to be called once, in the world and before any is placed.
void write_plant_objects(RibWriter& rib);

}  // namespace trapeze::scenes
