/// Point clouds in PRMan's format .ptc, as far as it is known: the layout that Partio (wdas/partio,
/// src/lib/io/PTC.cpp) reads and writes.
///
/// Little-endian: "pptc"; int version; double count; float bounds (lower x y z, upper x y z); of version 1
/// and later 4 floats; of version 2 another 33; float camera_from_world[16], screen_from_camera[16], width,
/// height, depth; int channels, floats of a point's channels; for each channel a line, "color _name\n"; of
/// version 1 and later 2 floats. Then for each point: float position[3]; unsigned short angle, height of the
/// normal; float radius; its channels' floats.
///
/// A normal is (cos' sin a, cos' cos a, z) with a = 2 pi (angle / 65535 - 1 / 2), z = 2 height / 65535 - 1
/// and cos' = sqrt(1 - z^2); both numbers 65535: none.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "shade/clouds/cloud_view.h"
#include "shade/clouds/point_cloud.h"

namespace trapeze {

/// Takes the next bytes of a file; false to end.
using CloudSink = std::function<bool(std::string_view)>;
/// About so many are handed over at a time.
inline constexpr size_t kCloudBytesAtOnce = size_t{1} << 20;

/// Writes version 0, as Partio does.
bool write_ptc(const PointCloud& cloud, const CloudView& view, const CloudSink& sink);

/// Reads versions 0 to 2. Nothing, and why, where the bytes are no such file; memory follows from their
/// number alone.
std::optional<PointCloud> read_ptc(std::string_view bytes, std::string* problem);

/// Whether a file begins as one.
bool is_ptc(std::string_view bytes);

}  // namespace trapeze
