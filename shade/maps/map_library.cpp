#include "shade/maps/map_library.h"

namespace trapeze {

const MapLibrary* map_library(std::string* problem) {
    static const OpenedModule opened = TRAPEZE_FIND_MODULE(maps);
    return offered_by<MapLibrary>(opened, problem);
}

}  // namespace trapeze
