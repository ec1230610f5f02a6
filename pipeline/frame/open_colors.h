/// Colour management as scenes, the command line and the environment ask for it.
#pragma once

#include <memory>

#include "core/colors/color_management.h"
#include "core/colors/color_request.h"
#include "core/diagnostics.h"
#include "core/files/access.h"

namespace trapeze {

/// The Diagnostic::kind of the error that there are no colours as they were asked for.
inline constexpr const char* kNoColors = "no-colors";

struct OpenedColors {
    std::shared_ptr<const ColorManagement> colors;  ///< null where nobody asks, and where it failed
    bool failed = false;                            ///< which has been reported
};

/// Opens what Option "ocio" of a scene asks for, with what the user asks for in its place. Where neither
/// names a config, that of $OCIO counts, if the environment may be seen; but by itself it asks for nothing,
/// which a note says once.
OpenedColors open_colors(const Options& options, const ColorRequest& users, const Access& access,
                         Diagnostics& diagnostics);

}  // namespace trapeze
