/// What area lights shine from [decision 0030].
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/math.h"

namespace trapeze {

struct LightInstance;

/// The shape of a light. Points on it are chosen anew for each point that it shines on.
struct LightShape {
    /// Rect, Disk, Sphere and Cylinder have the width 1 about the origin of the light's space, the first two
    /// in the plane z = 0. These shine along +z, the others outwards. A Cylinder is 1 long along x and open
    /// at its ends. Mesh: the primitives whose emitter the light is. Distant: a disk in the sky, which shines
    /// along +z. Dome: the whole sky, with its zenith at +z.
    enum class Kind : uint8_t { Rect, Disk, Sphere, Mesh, Distant, Dome, Cylinder };

    Kind kind = Kind::Mesh;
    int samples = kDefaultSamples;  ///< points for each point that it shines on; 1 .. kMostSamples
    bool two_sided = false;
    float angle = 0;          ///< Distant: from the middle of the disk to its rim, radians
    std::string map;          ///< Dome: a picture of all directions; empty: it is the same all around
    M44f camera_from_middle;  ///< Mesh: the light's space with its origin in the middle of its first shape

    static constexpr int kDefaultSamples = 16, kMostSamples = 2048;
};

/// The surface of a light of any shape at some time, in the camera's space at shutter open.
struct LightMesh {
    /// (b - a) x (c - a) points outside.
    struct Triangle {
        V3f a, b, c;
    };
    /// Round, as curves and particles are, of which a ribbon or a disk is drawn: they shine outwards alone.
    struct Tube {
        V3f from{0, 0, 0}, to{0, 0, 0};
        float from_radius = 0, to_radius = 0;
    };
    struct Ball {
        V3f middle{0, 0, 0};
        float radius = 0;
    };
    /// What a triangle's corners a, b and c are on their surface, and its derivatives at a as the shutter
    /// opens, before displacement.
    struct Place {
        std::array<V2f, 3> uv, st;
        V3f dPdu{0, 0, 0}, dPdv{0, 0, 0};
    };
    std::vector<Triangle> triangles;
    std::vector<Place> places;  ///< of the triangles; empty where the light's shader does not ask
    std::vector<Tube> tubes;
    std::vector<Ball> balls;
};
/// Each light at shutter open, and if it moves in the middles of equal parts of the shutter, too
/// (middle_of_part()).
using LightMeshes = std::map<const LightInstance*, std::vector<LightMesh>>;

}  // namespace trapeze
