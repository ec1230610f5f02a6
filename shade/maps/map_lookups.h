/// What lookups in maps are given and how they are filtered.
#pragma once

#include <cmath>
#include <string_view>

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

    LaneNumber sblur, tblur;  ///< added to the filtered region, as a part of the picture, of its height where
                              ///< it is an environment
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

// The planes of the lookups below fit the lanes, or hold one value for all (kLanes floats, or fewer than
// there are lanes), or are empty, which is zero. Values that are not finite count as zero.

/// Texture coordinates and how they change from a vertex to the next along u and v of the grid: what a lookup
/// is filtered over.
struct TextureLookup {
    ConstPlane s, t, dsdu, dtdu, dsdv, dtdv;
};

/// Directions, of any length, and how they change from a vertex to the next.
struct EnvironmentLookup {
    ConstPlane3 R, dRdu, dRdv;
};

/// Camera-space points, and how they change from a vertex to the next.
struct ShadowLookup {
    ConstPlane3 P, dPdu, dPdv;
};

/// A quadrilateral's middle and sides, of its corners in the order of a patch's (along u first): for the
/// lookups that are given four corners.
struct QuadSides {
    Plane middle, along_u, along_v;
};
void quad_sides(ConstPlane corner_00, ConstPlane corner_10, ConstPlane corner_01, ConstPlane corner_11,
                const QuadSides& sides);

}  // namespace trapeze
