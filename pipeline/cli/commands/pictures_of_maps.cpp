#include "pipeline/cli/commands/pictures_of_maps.h"

#include <algorithm>

#include "pipeline/cli/support/read_settings.h"
#include "pipeline/rib/syntax/arguments.h"

namespace trapeze {

std::set<std::string> pictures_of_maps(const Arguments& arguments, const std::atomic<bool>& cancelled) {
    std::set<std::string> pictures;
    if (std::ranges::find(arguments.inputs, "-") != arguments.inputs.end()) return pictures;
    Access access = scene_access(arguments);
    ReadOptions options = read_options(arguments, access);
    options.cancelled = &cancelled;
    options.keep_geometry = false;
    options.on_request = [](const rib::RequestText& request) {
        return !request.name.starts_with("Procedural");
    };
    options.on_map = [&](const MapRequest& request) {
        pictures.insert(request.pictures.begin(), request.pictures.end());
    };
    Diagnostics unheard;
    read_rib(arguments.inputs, options, unheard, [](Scene&&) {});
    return pictures;
}

}  // namespace trapeze
