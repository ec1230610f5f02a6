#include <algorithm>
#include <filesystem>

#include "pipeline/cli/commands/commands.h"
#include "pipeline/cli/commands/compliance_page.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/standard_streams.h"

namespace trapeze {

int compliance_command(const Arguments& arguments, Terminal&, Diagnostics& diagnostics) {
    std::vector<std::string> scenes;
    std::error_code error;
    for (const char* folder : {"/tiny", "/gallery"}) {
        const std::string place = arguments.scenes_folder + folder;
        for (const auto& entry : std::filesystem::directory_iterator(place, error)) {
            const std::string path = entry.path().string();
            if (path.ends_with(".rib") || path.ends_with(".rib.gz")) scenes.push_back(path);
        }
        if (!error) continue;
        diagnostics.error({}, "no folder \"" + place + "\"");
        return kExitNoInput;
    }
    std::sort(scenes.begin(), scenes.end());
    print_text(compliance_page(scenes));
    return kExitOk;
}

}  // namespace trapeze
