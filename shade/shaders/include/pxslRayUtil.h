/* What shaders that trace need beside the rays themselves: reflections with an environment behind. */
#ifndef PXSLRAYUTIL_H
#define PXSLRAYUTIL_H 1

#include "pxslUtil.h"
#include "reflections.h"

#endif
