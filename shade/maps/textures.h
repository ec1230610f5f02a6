/// Texture, environment and shadow maps of one render, through a TextureSystem of its own with bounded
/// memory. What includes textures_impl.h is all that knows OpenImageIO.
///
/// s runs across the picture and t down it, from its top row at 0. Numbers are taken as they are, unless
/// Option "color" "transfer" or a lookup's own "colorspace" asks for pictures of 8 and 16 bits to be taken to
/// linear light by the sRGB curve: that is done as they are read, before any filtering. Outside 0..1 a
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

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/depth_height.h"
#include "core/diagnostics.h"
#include "core/files/access.h"
#include "core/math.h"
#include "core/scene/scene.h"
#include "core/scene/transfer.h"
#include "shade/planes/planes.h"

namespace trapeze {

/// A number that may differ from lane to lane. What is not finite counts as zero.
class LaneNumber {
  public:
    LaneNumber(float value = 0) : value_(value) {}
    explicit LaneNumber(ConstPlane plane) : plane_(plane) {}

    float at(size_t lane) const {
        const float value = plane_.empty() ? value_ : plane_[lane];
        return std::isfinite(value) ? value : 0;
    }
    bool varies() const { return !plane_.empty(); }

  private:
    float value_ = 0;
    ConstPlane plane_;
};

/// How a lookup is filtered: RISpec 3.2's optional arguments of texture(), environment() and shadow()
/// (section 15.7).
struct MapOptions {
    enum class Filter : uint8_t { Smooth, Bilinear, Nearest };
    enum class Wrap : uint8_t { OfPicture, Black, Periodic, Clamp, Mirror };

    LaneNumber sblur, tblur;            ///< added to the filtered region, as a part of the picture
    LaneNumber swidth = 1, twidth = 1;  ///< what the region is multiplied by
    LaneNumber fill;                    ///< of channels that the file does not have
    float without = 0;                  ///< what texture() gives where there is no picture
    Wrap swrap = Wrap::OfPicture, twrap = Wrap::OfPicture;
    bool lerp = true;  ///< between two resolutions of the picture
    Filter filter = Filter::Smooth;
    LaneNumber first_channel;

    LaneNumber samples = 16;  ///< of a shadow; whole numbers from 1 to kMostShadowSamples
    LaneNumber bias = -1;     ///< of a shadow, in its camera's depth; below zero: as the render's options say
};
inline constexpr int kMostShadowSamples = 4096;

/// RISpec's filter names: "box" and "triangle" are bilinear, "nearest" and "closest" take a texel, all others
/// are smooth.
MapOptions::Filter map_filter(std::string_view name);
/// MakeTexture's names of wrap modes; that of the picture for all others.
MapOptions::Wrap map_wrap(std::string_view name);

/// Lanes of planes that a lookup is for.
struct Lanes {
    size_t count = 0;  ///< lanes past the last one are given its value in the output
    ConstPlane mask;   ///< lanes whose bits are all zero are left alone; empty: all are wanted
};

class Textures {
  public:
    /// Option "limits" "texturememory" (kilobytes) bounds the memory; searched are the folders of
    /// Option "searchpath" "texture"; Option "shadow" "bias" is the bias of shadows that have none of their
    /// own. diagnostics may be null; `access` must outlive this.
    Textures(const Options& options, Diagnostics* diagnostics, const Access& access = kEverything);
    ~Textures();
    Textures(const Textures&) = delete;
    Textures& operator=(const Textures&) = delete;

    /// An opened picture, of this object, whose numbers are taken as `transfer` says; null for an empty name
    /// or one that cannot be read, which is reported once. Thread-safe.
    class Picture;
    const Picture* find(std::string_view name, SourceLocation location, Transfer transfer = Transfer::Linear);

    /// How a lookup takes a picture's numbers: by its "colorspace", which may be empty, or as Option "color"
    /// "transfer" says. An unknown name is reported once. What is "auto" are numbers for lookups of floats.
    Transfer transfer_of_lookup(std::string_view colorspace, bool of_color, SourceLocation location) const;

    /// The same as a shadow map: null, and reported once, when it has no depths or no matrices.
    class DepthMap;
    const DepthMap* find_shadow(std::string_view name, SourceLocation location);

    /// For textureinfo() (RISpec 3.2, section 15.7); nothing when the file cannot be read, which is not
    /// reported. Thread-safe.
    struct Info {
        int width = 0, height = 0, channels = 0;
        std::string type;                       ///< "texture", "environment" or "shadow"
        std::string wrap_modes;                 ///< "periodic,clamp" as the file records it, or empty
        std::optional<M44f> viewing_matrix;     ///< camera_from_world of the map (row vectors)
        std::optional<M44f> projection_matrix;  ///< screen_from_world, -1..1 across the picture and up it
    };
    std::optional<Info> info(std::string_view name);

    // The planes of the inputs below fit the lanes, or hold one value for all (kLanes floats, or fewer than
    // there are lanes), or are empty, which is zero. Values that are not finite count as zero. All lookups
    // are thread-safe.

    /// Texture coordinates and how they change from a vertex to the next along u and v of the grid: what a
    /// lookup is filtered over.
    struct Lookup {
        ConstPlane s, t, dsdu, dtdu, dsdv, dtdv;
    };
    /// `out` are 1 or 3 planes: the picture's channels from the first that is asked for, options.fill those
    /// that it does not have. A null picture gives options.without.
    void texture(const Picture* picture, const Lookup& at, const MapOptions& options, Lanes lanes,
                 std::span<const Plane> out) const;

    /// Directions, of any length, and how they change from a vertex to the next.
    struct EnvironmentLookup {
        ConstPlane3 R, dRdu, dRdv;
    };
    void environment(const Picture* picture, const EnvironmentLookup& at, const MapOptions& options,
                     Lanes lanes, std::span<const Plane> out) const;

    /// Camera-space points, and how they change from a vertex to the next.
    struct ShadowLookup {
        ConstPlane3 P, dPdu, dPdv;
    };
    /// Percentage-closer filtering [Reeves87, "Rendering Antialiased Shadows with Depth Maps"]: the part, 0
    /// to 1, of what surrounds P in the map that is nearer to the map's camera than P is. See
    /// shadow_lookup.cpp. Nothing is in shadow outside the map, behind its camera, or of a null map.
    void shadow(const DepthMap* map, const ShadowLookup& at, const M44f& camera_from_world,
                const MapOptions& options, Lanes lanes, Plane out) const;

    /// Heights of points over what a shadow map saw, between its pixels' middles along planes. Empty for a
    /// name that find_shadow() has no map for, and for a map that is too large to be kept (which is
    /// reported). What is returned needs this object no more.
    DepthHeight height_over(std::string_view name, SourceLocation location, const M44f& camera_from_world);

    /// texture() of three channels, for all vertices.
    void lookup(const Picture& picture, const Lookup& at, size_t vertices, Plane3 out) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// A quadrilateral's middle and sides, of its corners in the order of a patch's (along u first): for the
/// lookups that are given four corners.
struct QuadSides {
    Plane middle, along_u, along_v;
};
void quad_sides(ConstPlane corner_00, ConstPlane corner_10, ConstPlane corner_01, ConstPlane corner_11,
                const QuadSides& sides);

}  // namespace trapeze
