#include "sample/embree/embree_library.h"

namespace trapeze {

const EmbreeLibrary* embree_library(std::string* problem) {
    static const OpenedModule opened = TRAPEZE_FIND_MODULE(embree);
    return offered_by<EmbreeLibrary>(opened, problem);
}

}  // namespace trapeze
