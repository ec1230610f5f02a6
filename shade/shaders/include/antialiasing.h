/* Steps, pulses and noises averaged over a filter's width. */
#ifndef ANTIALIASING_H
#define ANTIALIASING_H 1

#include "filterwidth.h"
#include "noises.h"
#include "patterns.h"

#endif
