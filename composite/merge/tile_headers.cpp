#include "composite/merge/tile_headers.h"

#include <OpenEXR/ImfAttribute.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string_view>

#include "composite/merge/merge_error.h"
#include "core/files/picture_files.h"

namespace trapeze {
namespace {

/// Attributes that all tiles of a picture have alike.
constexpr std::string_view kOfThePicture[] = {
    "displayWindow",     "channels",      "pixelAspectRatio", "screenWindowCenter",
    "screenWindowWidth", "worldToCamera", "worldToNDC",       "frame"};
/// Attributes that say how a file is stored, which is the first's or the merged file's own affair.
constexpr std::string_view kOfOneFile[] = {
    "chunkCount",          "compression", "dataWindow", "lineOrder", "name", "maxSamplesPerPixel",
    "dwaCompressionLevel", "tiles",       "type",       "version",   "tile"};
constexpr const char* kTileAttribute = "tile";
constexpr const char* kDate = "capDate";  ///< stays the first tile's
constexpr std::string_view kOfTheRun[] = {"renderTime",
                                          "renderStats"};  ///< of a tile alone say nothing of the picture

template <class Names>
bool has_name(const Names& names, std::string_view name) {
    return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

/// The attribute's type and its bytes in a file.
std::string value_of(const Imf::Attribute& attribute) {
    Imf::StdOSStream bytes;
    attribute.writeValueTo(bytes, Imf::EXR_VERSION);
    return std::string(attribute.typeName()) + '\0' + bytes.str();
}

std::optional<PictureTile> tile_of(const Imf::Header& header) {
    const auto* const name = header.findTypedAttribute<Imf::StringAttribute>(kTileAttribute);
    return name ? tile_named(name->value()) : std::nullopt;
}

/// Why files of this header cannot be joined; empty: they can.
std::string problem_of(const Imf::Header& header) {
    if (header.hasType() && header.type() == Imf::DEEPTILE) return "deep pixels are stored in tiles";
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
            return fmt::format("channel \"{}\" does not have a value for every pixel", channel.name());
    return {};
}

Imf::Header header_of(const std::string& path) {
    std::error_code failed;
    const auto status = std::filesystem::status(path, failed);
    if (!std::filesystem::exists(status)) throw unreadable(path, "there is no such file");
    if (!std::filesystem::is_regular_file(status)) throw unreadable(path, "it is no file");
    if (picture_format(path) != "openexr") throw unreadable(path, "it is no OpenEXR file");
    try {
        Imf::MultiPartInputFile file(path.c_str(), 0);
        if (file.parts() != 1) throw unreadable(path, fmt::format("it has {} parts, not one", file.parts()));
        if (!file.partComplete(0)) throw unreadable(path, "it is not complete");
        const std::string problem = problem_of(file.header(0));
        if (!problem.empty()) throw unreadable(path, problem);
        return file.header(0);
    } catch (const MergeError&) {
        throw;
    } catch (const std::exception& failure) {
        throw unreadable(path, failure.what());
    }
}

bool has_deep_samples(const Imf::Header& header) {
    return header.hasType() && header.type() == Imf::DEEPSCANLINE;
}

}  // namespace

void TileHeaders::add(const std::string& path) {
    const Imf::Header header = header_of(path);
    const TileFile file{path, header.dataWindow(), tile_of(header)};
    if (files_.empty())
        add_first(header);
    else
        compare_with_first(file, header);
    files_.push_back(file);
}

void TileHeaders::add_first(const Imf::Header& header) {
    first_ = header;
    is_deep_ = has_deep_samples(header);
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
        values_[attribute.name()] = value_of(attribute.attribute());
}

void TileHeaders::compare_with_first(const TileFile& file, const Imf::Header& header) {
    const TileFile& first = files_.front();
    const auto refuse = [&](const std::string& reason) {
        throw MergeError(MergeOutcome::NoPicture, fmt::format("\"{}\" and \"{}\" are not of one picture: {}",
                                                              first.path, file.path, reason));
    };
    if (has_deep_samples(header) != is_deep_) refuse("one is deep, the other is not");
    for (const std::string_view name : kOfThePicture) {
        const auto own = header.find(std::string(name).c_str());
        const auto known = values_.find(std::string(name));
        const bool is_there = own != header.end();
        if (is_there != (known != values_.end()) || (is_there && value_of(own.attribute()) != known->second))
            refuse(fmt::format("their attributes \"{}\" differ", name));
    }
    if (first.tile && file.tile &&
        (first.tile->columns != file.tile->columns || first.tile->rows != file.tile->rows))
        refuse(fmt::format("one is tile {}, the other {}", name_of(*first.tile), name_of(*file.tile)));
    for (const auto& [name, value] : values_) {
        if (has_name(kOfThePicture, name) || has_name(kOfOneFile, name)) continue;
        const auto own = header.find(name.c_str());
        if (own == header.end() || value_of(own.attribute()) != value)
            different_.try_emplace(name, file.path);
    }
}

Box2i TileHeaders::window() const {
    Box2i all;
    for (const TileFile& file : files_) all.extendBy(file.window);
    return all;
}

bool TileHeaders::is_stored_in_tiles() const {
    return !is_deep_ && first_.hasTileDescription() && first_.tileDescription().mode == Imf::ONE_LEVEL;
}

Imf::Header TileHeaders::merged(Diagnostics& diagnostics) const {
    Imf::Header header;
    for (auto attribute = first_.begin(); attribute != first_.end(); ++attribute) {
        const std::string name = attribute.name();
        const auto other = different_.find(name);
        if (other != different_.end() && name != kDate) {
            if (std::find(std::begin(kOfTheRun), std::end(kOfTheRun), name) == std::end(kOfTheRun))
                diagnostics.warning(
                    {}, fmt::format("attribute \"{}\" is left out: \"{}\" and \"{}\" differ in it", name,
                                    files_.front().path, other->second));
            continue;
        }
        // Files of one flat part have no type.
        const bool is_dropped = name == kTileAttribute || name == "chunkCount" ||
                                (name == "tiles" && !is_stored_in_tiles()) || (name == "type" && !is_deep_);
        if (!is_dropped) header.insert(name, attribute.attribute());
    }
    header.lineOrder() = Imf::INCREASING_Y;
    header.dataWindow() = window();
    return header;
}

}  // namespace trapeze
