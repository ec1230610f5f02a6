#include "pipeline/preview/web_server.h"

namespace trapeze {

const WebLibrary* web_library(std::string* problem) {
    static const OpenedModule opened = TRAPEZE_FIND_MODULE(web);
    return offered_by<WebLibrary>(opened, problem);
}

}  // namespace trapeze
