#include "pipeline/cli/read_settings.h"

#include "pipeline/rib/user_defaults.h"

namespace trapeze {

ReadOptions read_options(const Arguments& arguments) {
    ReadOptions options;
    options.defaults_file = user_defaults_file();
    for (const std::string& rib : arguments.first_rib) options.first_texts.push_back({"--option", rib});
    options.allow_programs = arguments.allow_programs;
    return options;
}

}  // namespace trapeze
