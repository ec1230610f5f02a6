#include "composite/colors/color_library.h"

namespace trapeze {

const ColorLibrary* color_library(std::string* problem) {
    static const OpenedModule opened = TRAPEZE_FIND_MODULE(colors);
    return offered_by<ColorLibrary>(opened, problem);
}

}  // namespace trapeze
