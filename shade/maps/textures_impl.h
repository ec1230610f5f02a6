/// What the files of Textures share; theirs alone.
#pragma once

#include <map>
#include <mutex>

#include "shade/maps/map_library.h"
#include "shade/maps/textures.h"

namespace trapeze {

class Textures::Picture {
  public:
    std::unique_ptr<OpenMap> map;
    std::string file;
    std::string name;
    SourceLocation location;
};

class Textures::DepthMap {
  public:
    const OpenMap* map = nullptr;  ///< its picture's
    DepthView view;
    std::string name;
    SourceLocation location;
};

struct Textures::Impl {
    std::unique_ptr<MapCache> cache;  ///< made when the first file is opened
    std::vector<std::string> folders;
    float memory_megabytes = 0;
    float shadow_bias = -1;  ///< below zero: none is set
    Transfer transfer = Transfer::Linear;
    Diagnostics* diagnostics = nullptr;
    const Access& access;

    /// A picture or depth map, or why there is none.
    template <class Map>
    struct Entry {
        std::unique_ptr<Map> map;
        std::string problem;
        bool reported = false;
    };
    std::mutex mutex;
    std::map<std::string, Entry<Picture>, std::less<>> pictures;  ///< numbers as they are
    std::map<std::string, Entry<Picture>, std::less<>> decoded;   ///< the same names, from sRGB
    std::map<std::string, Entry<DepthMap>, std::less<>> depth_maps;

    explicit Impl(const Access& files) : access(files) {}

    /// Whole depth maps, for as long as somebody uses them; with a mutex of their own.
    std::mutex depths_mutex;
    std::map<std::string, std::weak_ptr<const std::vector<float>>, std::less<>> depths;
    std::shared_ptr<const std::vector<float>> all_depths(const DepthMap& map, SourceLocation location);

    /// Makes the cache, which a render without textures goes without, and opens the module that has it.
    /// Returns why there is none. The mutex is held.
    std::string start();
    Entry<Picture>& entry(std::string_view name, SourceLocation location);
    Entry<Picture>& decoded_entry(const Picture& picture);
    std::string open(Picture& picture);
    std::string open(DepthMap& map);
    template <class Map>
    const Map* report(Entry<Map>& entry, std::string_view name, SourceLocation location);
    void report_read_error(const std::string& name, SourceLocation location, std::string error);
    /// The same as a lookup in the map calls it.
    template <class Map>
    ReadFailed reporter(const Map& map) {
        return
            [this, &map](std::string error) { report_read_error(map.name, map.location, std::move(error)); };
    }
};

}  // namespace trapeze
