/// What a scene or the command line asks of colour management: names in a config of OpenColorIO, unchecked.
#pragma once

#include <string>

#include "core/scene/scene.h"

namespace trapeze {

/// Option "ocio". What is empty nobody says; the config then has a usual one.
struct ColorRequest {
    std::string config = {};                         ///< a file
    std::string display = {}, view = {}, look = {};  ///< for files of whole numbers
    std::string working_space = {};                  ///< of all colours of the scene and its shaders

    /// Whether somebody asks for colour management at all.
    bool asks() const {
        return !(config.empty() && display.empty() && view.empty() && look.empty() && working_space.empty());
    }
};

/// What Option "ocio" of the scene says.
ColorRequest color_request_of(const Options& options);

/// `stronger` in place of `request`. Names belong together: another config takes all of `request`'s names
/// away, another display its view and look, another view its look.
ColorRequest replaced(ColorRequest request, const ColorRequest& stronger);

}  // namespace trapeze
