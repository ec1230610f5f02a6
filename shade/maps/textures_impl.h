/// What the source files of Textures share, and nobody else sees.
#pragma once

#include <map>
#include <mutex>

#include "shade/maps/map_library.h"
#include "shade/maps/textures.h"

namespace trapeze {

/// An opened picture and where it was first asked for.
class Textures::Picture {
  public:
    std::unique_ptr<OpenMap> map;
    std::string file;  ///< path of the picture's file
    std::string name;  ///< as the shader gave it
    SourceLocation location;
};

/// A picture that has depths and its camera's matrices.
class Textures::DepthMap {
  public:
    const OpenMap* map = nullptr;  ///< its picture's
    DepthView view;
    std::string name;
    SourceLocation location;
};

struct Textures::Impl {
    /// From colour spaces to the working space; null where nothing is to be done, or can be, which the text
    /// says. The cache's readers use them.
    std::map<std::string, std::pair<std::shared_ptr<const ColorTransform>, std::string>> transforms;
    std::unique_ptr<MapCache> cache;  ///< made when the first file is opened
    std::vector<std::string> folders;
    float memory_megabytes = 0;
    float shadow_bias = -1;  ///< of Option "shadow" "bias"; below zero: none is set
    Transfer transfer = Transfer::Linear;
    std::shared_ptr<const ColorManagement> colors;  ///< null: none
    Diagnostics* diagnostics = nullptr;
    const Access& access;

    /// A picture or depth map, or why there is none.
    template <class Map>
    struct Entry {
        std::unique_ptr<Map> map;
        std::string problem;
        bool reported = false;
    };
    std::mutex mutex;  ///< for all maps below; `depths` has a mutex of its own
    std::map<std::string, Entry<Picture>, std::less<>> pictures;  ///< numbers as they are
    std::map<std::string, Entry<Picture>, std::less<>> decoded;   ///< the same names, from sRGB
    std::map<std::string, Entry<DepthMap>, std::less<>> depth_maps;
    /// By space and name, from that space.
    std::map<std::pair<std::string, std::string>, Entry<Picture>> converted;
    std::map<std::string, std::string> spaces_by_rules;  ///< of files

    explicit Impl(const Access& files) : access(files) {}

    /// Depths of whole maps by name, for as long as somebody uses them. Reading one takes long, hence the
    /// mutex of its own.
    std::mutex depths_mutex;
    std::map<std::string, std::weak_ptr<const std::vector<float>>, std::less<>> depths;
    /// The depths of a map, row by row; null, and reported, when they cannot be read or are too many.
    std::shared_ptr<const std::vector<float>> all_depths(const DepthMap& map, SourceLocation location);

    /// Reading a map takes long, too. No more than kMostSkies are kept.
    std::mutex skies_mutex;
    std::map<std::string, std::shared_ptr<const SkyParts>, std::less<>> skies;

    /// Makes the cache when the first file is opened, which also opens the module that has it. Returns why
    /// there is none, or nothing. The mutex is held.
    std::string start();
    Entry<Picture>& entry(std::string_view name, SourceLocation location);
    Entry<Picture>& decoded_entry(const Picture& picture);
    /// The picture from a colour space: itself, where nothing is to be done.
    const Picture* converted_picture(const Picture& picture, const std::string& space,
                                     SourceLocation location);
    const std::string& space_by_rules(const std::string& file);
    std::string open(Picture& picture);
    std::string open(DepthMap& map);
    template <class Map>
    const Map* report(Entry<Map>& entry, std::string_view name, SourceLocation location);
    void report_read_error(const std::string& name, SourceLocation location, std::string error);
    /// What a lookup in the map calls when it cannot read the file.
    template <class Map>
    ReadFailed reporter(const Map& map) {
        return
            [this, &map](std::string error) { report_read_error(map.name, map.location, std::move(error)); };
    }
};

}  // namespace trapeze
