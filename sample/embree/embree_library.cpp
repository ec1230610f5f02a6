#include "sample/embree/embree_library.h"

namespace trapeze {

/// The module is opened once for the process, by whoever asks first; a failure is remembered, and its reason
/// given to all who ask.
const EmbreeLibrary* embree_library(std::string* problem) {
    static const OpenedModule opened = TRAPEZE_FIND_MODULE(embree);
    return offered_by<EmbreeLibrary>(opened, problem);
}

}  // namespace trapeze
