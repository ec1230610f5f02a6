#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTileDescription.h>

#include <algorithm>
#include <exception>

#include "shade/maps/headers/formats.h"

namespace trapeze {
namespace {

/// Whether there is a matrix of the name, in capitals or not: OpenImageIO writes none.
bool has_matrix(const Imf::Header& header, std::string_view name) {
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
        std::string lower = attribute.name();
        std::transform(lower.begin(), lower.end(), lower.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (lower == name) return dynamic_cast<const Imf::M44fAttribute*>(&attribute.attribute()) != nullptr;
    }
    return false;
}

std::optional<MapHeader> plain_part(const Imf::Header& header) {
    if (header.hasType() && Imf::isDeepData(header.type())) return {};
    const Imath::Box2i& window = header.dataWindow();
    const int64_t width = int64_t{window.max.x} - window.min.x + 1;
    const int64_t height = int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 ||
        !is_plain_size(static_cast<uint64_t>(width), static_cast<uint64_t>(height)))
        return {};
    constexpr uint32_t kMostTileSide = 1024;
    if (header.hasTileDescription() &&
        std::max(header.tileDescription().xSize, header.tileDescription().ySize) > kMostTileSide)
        return {};
    int channels = 0;
    bool is_float = true;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
        const Imf::Channel& its = channel.channel();
        if (its.xSampling != 1 || its.ySampling != 1) return {};
        is_float = is_float && its.type == Imf::FLOAT;
        ++channels;
    }
    if (channels < 1 || channels > 16) return {};
    MapHeader found;
    found.is_one_float = channels == 1 && is_float;
    found.has_matrices = has_matrix(header, "worldtocamera") &&
                         (has_matrix(header, "worldtoscreen") || has_matrix(header, "worldtondc"));
    return found;
}

}  // namespace

std::optional<MapHeader> plain_exr(const std::string& path) {
    try {
        const Imf::MultiPartInputFile file(path.c_str(), 0, false);
        return file.parts() == 1 ? plain_part(file.header(0)) : std::nullopt;
    } catch (const std::exception&) {  // OpenEXR's, of a file that it cannot read
        return {};
    }
}

}  // namespace trapeze
