#include "shade/maps/headers/map_header.h"

#include "core/files/picture_files.h"
#include "shade/maps/headers/formats.h"

namespace trapeze {

std::optional<MapHeader> plain_map_header(const std::string& path) {
    const std::string_view format = picture_format(path);
    if (format == "openexr") return plain_exr(path);
    HeaderBytes bytes(path);
    if (format == "png") return plain_png(bytes);
    if (format == "jpeg") return plain_jpeg(bytes);
    if (format == "tiff") return plain_tiff(bytes);
    return {};
}

}  // namespace trapeze
