/// Texture, environment and shadow maps of one render, through a TextureSystem of its own with bounded
/// memory. What knows OpenImageIO is in the folder openimageio, behind map_library.h.
///
/// s runs across the picture and t down it, from its top row at 0. Numbers are taken as they are, unless
/// Option "color" "transfer" or a lookup's own "colorspace" asks for pictures of 8 and 16 bits to be taken to
/// linear light by the sRGB curve, or colour management knows their colour space: what that asks for is done
/// as they are read, before any filtering. Outside 0..1 a
/// picture is as its own metadata says, which MakeTexture writes (RISpec 3.2, section 7.1); without, it is
/// black.
///
/// Environment maps are pictures of all directions by longitude and latitude, as RISpec has them (section
/// 7.2): a direction is (cos(lon) cos(lat), sin(lon) cos(lat), sin(lat)); longitude runs from 0 at the left
/// edge to 360 degrees at the right, latitude from 90 degrees at the top to -90. (A map in OpenEXR that is
/// marked as one has y up and +z in the middle, as that format's specification says.)
///
/// Shadow maps are pictures of camera-space depth with the metadata worldtocamera and worldtoscreen.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/colors/color_management.h"
#include "core/colors/transfer.h"
#include "core/depth_height.h"
#include "core/diagnostics.h"
#include "core/files/access.h"
#include "core/math.h"
#include "core/scene/scene.h"
#include "shade/maps/map_lookups.h"

namespace trapeze {

/// How the numbers of a picture are taken.
struct TextureReading {
    Transfer transfer = Transfer::Linear;
    std::string space = {};      ///< of colour management, in place of the transfer; empty: none is named
    bool follows_rules = false;  ///< of its config, for names of files, where they are for this picture

    TextureReading(Transfer its_transfer = Transfer::Linear) : transfer(its_transfer) {}
};

class SkyParts;

class Textures {
  public:
    /// Option "limits" "texturememory" (kilobytes) bounds the memory; searched are the folders of
    /// Option "searchpath" "texture"; Option "shadow" "bias" is the bias of shadows that have none of their
    /// own. diagnostics may be null; `access` must outlive this. Without `colors` there is no colour
    /// management.
    Textures(const Options& options, Diagnostics* diagnostics, const Access& access = kEverything,
             std::shared_ptr<const ColorManagement> colors = {});
    ~Textures();
    Textures(const Textures&) = delete;
    Textures& operator=(const Textures&) = delete;

    /// An opened picture, of this object, whose numbers are taken as `reading` says; null for an empty name
    /// or one that cannot be read, which is reported once. Thread-safe.
    class Picture;
    const Picture* find(std::string_view name, SourceLocation location, const TextureReading& reading = {});

    /// How a lookup takes a picture's numbers: by its "colorspace", which may be empty, or by the rules of
    /// colour management, or as Option "color" "transfer" says. An unknown name is reported once. Rules and
    /// "auto" are for lookups of colours.
    TextureReading reading_of_lookup(std::string_view colorspace, bool of_color,
                                     SourceLocation location) const;

    /// Opens a picture as a shadow map: null, and reported once, when it has no depths or no matrices.
    class DepthMap;
    const DepthMap* find_shadow(std::string_view name, SourceLocation location);

    /// Reports of a name what find() would, or find_shadow() where it is of depths. OpenImageIO is not loaded
    /// for files whose headers leave no doubt.
    void check(std::string_view name, SourceLocation location, bool is_depths);

    /// What textureinfo() asks of a file (RISpec 3.2, section 15.7), matrices from world space; nothing when
    /// it cannot be read, which is not reported. Thread-safe.
    struct Info {
        int width = 0, height = 0, channels = 0;
        std::string type;                       ///< "texture", "environment" or "shadow"
        std::string wrap_modes;                 ///< "periodic,clamp" as the file records it, or empty
        std::optional<M44f> viewing_matrix;     ///< camera_from_world of the map (row vectors)
        std::optional<M44f> projection_matrix;  ///< screen_from_world, -1..1 across the picture and up it
    };
    std::optional<Info> info(std::string_view name);

    /// An environment map in parts that send as much light each; null for one that cannot be read, which is
    /// reported once. Thread-safe.
    std::shared_ptr<const SkyParts> sky_parts(std::string_view name, SourceLocation location);

    // All lookups are thread-safe.

    /// `out` are 1 or 3 planes: the picture's channels from the first that is asked for, options.fill those
    /// that it does not have. A null picture gives options.without.
    void texture(const Picture* picture, const TextureLookup& at, const MapOptions& options, Lanes lanes,
                 std::span<const Plane> out) const;

    void environment(const Picture* picture, const EnvironmentLookup& at, const MapOptions& options,
                     Lanes lanes, std::span<const Plane> out) const;

    /// Percentage-closer filtering [Reeves87, "Rendering Antialiased Shadows with Depth Maps"]: the part, 0
    /// to 1, of what surrounds P in the map that is nearer to the map's camera than P is. See
    /// openimageio/shadow_lookup.cpp. Nothing is in shadow outside the map, behind its camera, or of a null
    /// map.
    void shadow(const DepthMap* map, const ShadowLookup& at, const M44f& camera_from_world,
                const MapOptions& options, Lanes lanes, Plane out) const;

    /// Heights of points over what a shadow map saw, between its pixels' middles along planes. Empty for a
    /// name that find_shadow() has no map for, and for a map that is too large to be kept (which is
    /// reported). What is returned needs this object no more.
    DepthHeight height_over(std::string_view name, SourceLocation location, const M44f& camera_from_world);

    /// texture() of three channels, for all vertices.
    void lookup(const Picture& picture, const TextureLookup& at, size_t vertices, Plane3 out) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace trapeze
