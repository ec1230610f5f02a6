/// What Textures and make_maps ask of a library of pictures: files looked up through a cache, pictures read
/// whole, and maps made of them. It is OpenImageIO, in the module "maps" (folder openimageio).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/colors/color_management.h"
#include "core/colors/transfer.h"
#include "core/files/module.h"
#include "core/math.h"
#include "shade/maps/cube_faces.h"
#include "shade/maps/map_lookups.h"
#include "shade/maps/map_space.h"

namespace trapeze {

/// The matrices that say where a depth map was seen from, in a file's metadata: RenderMan's worldtocamera and
/// worldtoscreen, or OpenEXR's worldToCamera and worldToNDC.
struct MapMatrices {
    M44f camera_from_world, screen_from_world;  ///< screen: -1..1 across the picture and up it
};

/// What a file says of its first picture.
struct MapFacts {
    int full_width = 0, full_height = 0, channels = 0;
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< the pixels of the whole picture that the file has
    bool is_one_float = false;           ///< one channel of floats, as depths are
    bool has_colors = false;             ///< three channels or more beside alpha
    bool srgb_if_asked = false, srgb_by_itself = false;  ///< is_srgb_encoded() for Srgb and Auto
    std::string wrap_modes;                              ///< "periodic,clamp", or empty
    std::string texture_format;                          ///< "Shadow", "LatLong Environment", or empty
    std::optional<MapMatrices> matrices;
};

/// A file that a MapCache has opened; gone before the cache is.
class OpenMap {
  public:
    virtual ~OpenMap() = default;
    MapFacts facts;
};

/// Is called where a lookup cannot read its file, with the reason; the lane is then zero.
using ReadFailed = std::function<void(std::string)>;

/// Files of one render, in bounded memory. Opening is for one thread at a time; lookups are thread-safe.
/// Texts that say what went wrong are empty where all is well.
class MapCache {
  public:
    virtual ~MapCache() = default;

    /// Null, with *problem set, when the file cannot be read or is no picture of rows and columns.
    virtual std::unique_ptr<OpenMap> open(const std::string& file, std::string* problem) = 0;
    /// Opens the picture of `map` again, decoded from sRGB.
    virtual std::unique_ptr<OpenMap> open_decoded(const OpenMap& map, const std::string& file,
                                                  std::string* problem) = 0;
    /// The same, brought from a colour space to another one. The transform must outlive the cache.
    virtual std::unique_ptr<OpenMap> open_converted(const OpenMap& map, const std::string& file,
                                                    const std::string& space, const ColorTransform& transform,
                                                    std::string* problem) = 0;

    /// As Textures has these, but the map must be there.
    virtual void texture(const OpenMap& map, const TextureLookup& at, const MapOptions& options, Lanes lanes,
                         std::span<const Plane> out, const ReadFailed& failed) = 0;
    virtual void environment(const OpenMap& map, const EnvironmentLookup& at, const MapOptions& options,
                             Lanes lanes, std::span<const Plane> out, const ReadFailed& failed) = 0;

    struct ShadowMap {
        const OpenMap& map;
        DepthView view;
        float bias = -1;  ///< of lookups that have none of their own; below zero: none
    };
    virtual void shadow(const ShadowMap& map, const ShadowLookup& at, const M44f& camera_from_world,
                        const MapOptions& options, Lanes lanes, Plane out, const ReadFailed& failed) = 0;

    /// Reads all depths of a map, row by row. Returns what went wrong.
    virtual std::string read_depths(const OpenMap& map, std::vector<float>& depths) = 0;
};

/// A picture read whole, as floats.
struct SourcePicture {
    Raster raster;
    bool fits_halves = false;  ///< the file's numbers are halves or of 8 bits, which halves hold exactly
    std::vector<std::string> channel_names;
    /// The place of the first pixel in the whole picture, and the size of that.
    int x = 0, y = 0, full_width = 0, full_height = 0;
    std::optional<MapMatrices> matrices;
};

/// The form of a map that is made.
struct MapForm {
    std::string wrap_modes;  ///< "periodic,clamp"
    std::string filter;      ///< RISpec's or OpenImageIO's name; "box" stands for those that are not known
    bool halves = false;
};

/// A map's file, or why there is none. OpenImageIO's writer of OpenEXR waits for ever where a disk is full;
/// whoever has the bytes can write them and notice.
struct MapBytes {
    std::vector<unsigned char> bytes;
    std::string problem;
};

/// The library of pictures.
class MapLibrary {
  public:
    /// A cache of files for one render. `megabytes` bounds its memory.
    virtual std::unique_ptr<MapCache> make_cache(float megabytes) const = 0;

    /// Reads a picture whole. Returns what went wrong. Numbers that are encoded by the sRGB curve, as
    /// `transfer` tells, are decoded.
    virtual std::string read(const std::string& file, Transfer transfer, SourcePicture& picture) const = 0;

    /// A map as an OpenEXR file, with smaller and smaller pictures.
    virtual MapBytes texture_map(Raster& picture, const MapForm& form) const = 0;
    /// Writes an environment map to a file, as OpenImageIO makes a TIFF of several pictures on the disk only.
    /// TIFF, since maps in OpenEXR have another direction up. Returns what went wrong.
    virtual std::string write_environment_map(Raster& picture, const MapForm& form,
                                              const std::string& file) const = 0;
    /// A picture's depths as a TIFF file, with the matrices in its metadata.
    virtual MapBytes shadow_map(const SourcePicture& picture, const std::vector<float>& depths) const = 0;

  protected:
    ~MapLibrary() = default;
};

/// The library, from the module "maps", which is opened once; null, with *problem set, where that cannot be
/// opened.
const MapLibrary* map_library(std::string* problem);

}  // namespace trapeze

extern "C" {
[[gnu::visibility("default")]] extern const trapeze::ModuleEntry trapeze_maps_module;
}
