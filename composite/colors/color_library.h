/// What manages colours: OpenColorIO, in the module "colors".
#pragma once

#include <memory>
#include <string>

#include "core/colors/color_management.h"
#include "core/colors/color_request.h"
#include "core/files/module.h"

namespace trapeze {

/// What the module offers: the program itself is not linked with OpenColorIO. Any thread may use it.
class ColorLibrary {
  public:
    /// Opens the config of the request, or the built-in one where it names none, and looks up its names.
    /// Null, with *problem set in one line without the config's name, where that fails.
    virtual std::shared_ptr<const ColorManagement> open(const ColorRequest& request,
                                                        std::string* problem) const = 0;

  protected:
    ~ColorLibrary() = default;
};

/// The library, from the module "colors"; null, with *problem set, where that cannot be opened.
const ColorLibrary* color_library(std::string* problem);

}  // namespace trapeze

extern "C" {
[[gnu::visibility("default")]] extern const trapeze::ModuleEntry trapeze_colors_module;
}
