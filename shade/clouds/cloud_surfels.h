/// The points of a cloud as discs.
#pragma once

#include <string_view>

#include "core/scene/surfels.h"
#include "shade/clouds/point_cloud.h"

namespace trapeze {

/// Areas are those of the channel "_area", where there is one, else of discs of the points' radii;
/// radiosities are the colours "_radiosity". Points without an area are left out.
Surfels surfels_of(const PointCloud& cloud);

}  // namespace trapeze
