/// The config for those who ask for a view and name no config.
#pragma once

#include <OpenColorIO/OpenColorIO.h>

namespace trapeze {

/// Its display and view, which is the curve of core's "transfer" "srgb".
inline constexpr const char* kBuiltInDisplay = "sRGB";
inline constexpr const char* kBuiltInView = "sRGB";

/// Spaces "Linear Rec.709" (the working space, also lin_rec709 and "linear"), "sRGB" and "Raw"; display
/// "sRGB" with the views "sRGB" and "Raw"; no looks. OpenColorIO 2.1 has no config of its own.
OCIO_NAMESPACE::ConstConfigRcPtr make_built_in_config();

}  // namespace trapeze
