/// Pictures by what their files begin with.
#pragma once

#include <string>
#include <string_view>

namespace trapeze {

/// The line by which PLY files of this program are known.
inline constexpr std::string_view kCloudComment = "comment point cloud of Trapeze";

/// OpenImageIO's name of the format, "openexr" or "tiff", of the formats that pictures are mostly in; empty
/// for all other files.
std::string_view picture_format(const std::string& path);

/// Whether a file is a point cloud as this program writes them: PRMan's, or PLY with a comment that says so.
bool is_baked_cloud(const std::string& path);

/// Whether a file is such a picture and is called one, so that every reader takes it for what it is.
bool is_common_picture(const std::string& path);

}  // namespace trapeze
