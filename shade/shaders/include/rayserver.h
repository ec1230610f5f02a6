/* Rays are the renderer's own. */
#ifndef RAYSERVER_H
#define RAYSERVER_H 1

#include "raysphere.h"

#endif
