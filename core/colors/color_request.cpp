#include "core/colors/color_request.h"

namespace trapeze {

ColorRequest color_request_of(const Options& options) {
    const auto named = [&](const char* name) { return options.user.string_or("ocio", name, ""); };
    return {named("config"), named("display"), named("view"), named("look"), named("workingspace")};
}

ColorRequest replaced(ColorRequest request, const ColorRequest& stronger) {
    if (!stronger.config.empty()) request = {.config = stronger.config};
    if (!stronger.display.empty()) request.display = stronger.display, request.view = request.look = "";
    if (!stronger.view.empty()) request.view = stronger.view, request.look = "";
    if (!stronger.look.empty()) request.look = stronger.look;
    if (!stronger.working_space.empty()) request.working_space = stronger.working_space;
    return request;
}

}  // namespace trapeze
