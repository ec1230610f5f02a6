/// What follows a k and a name in an AFF file: { keys of a translation, rotation, scale, visibility }.
#pragma once

#include "pipeline/study/aff/aff_animation.h"
#include "pipeline/study/aff/aff_words.h"

namespace trapeze {

/// What it is worth only if words have not failed.
AffAnimation read_keyframes(AffWords& words);

}  // namespace trapeze
