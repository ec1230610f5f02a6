#include "composite/displays/image_library.h"

namespace trapeze {

const ImageLibrary* image_library(std::string* problem) {
    static const OpenedModule opened = TRAPEZE_FIND_MODULE(displays);
    return offered_by<ImageLibrary>(opened, problem);
}

}  // namespace trapeze
