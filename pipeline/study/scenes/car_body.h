/// A car's body as a subdivision surface, in metres: z towards the nose, y up, the ground at 0.
#pragma once

#include "pipeline/study/scenes/rib_writer.h"

namespace trapeze::scenes {

enum class BodyPiece { kPaint, kGlass, kTrim, kTailLamps };

/// Writes the faces of one piece; their colour is that of the current attributes.
void write_car_body(RibWriter& rib, BodyPiece piece);

}  // namespace trapeze::scenes
