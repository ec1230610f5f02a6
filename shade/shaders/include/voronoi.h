/* Cells about scattered points: voronoi_f1_2d, voronoi_f1f2_2d, voronoi_f1_3d, voronoi_f1f2_3d. */
#ifndef VORONOI_H
#define VORONOI_H 1

#include "noises.h"

#endif
