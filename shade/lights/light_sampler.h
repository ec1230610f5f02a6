/// Points on the shapes of area lights, chosen for a point that they shine on [decision 0030]. The camera's
/// space at shutter open.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/math.h"
#include "core/scene/light_shape.h"
#include "shade/lights/sky_picture.h"

namespace trapeze {

/// A point on a light.
struct LightSample {
    V3f P{0, 0, 0};
    V3f N{0, 0, 1};  ///< of unit length, to where it shines; of lights that are nowhere, along the light
    float solid_angle = 0;  ///< that it stands for if it is the only one, 1 / density; 0: nothing arrives
    V3f radiance{1, 1, 1};  ///< of a dome, by its map
    /// Where P is on the surface of a mesh that knows (LightMesh::places); else 0.
    V2f uv{0, 0}, st{0, 0};
    V3f dPdu{0, 0, 0}, dPdv{0, 0, 0};
};

/// A light's shape. Immutable: threads share it.
class LightSampler {
  public:
    virtual ~LightSampler() = default;

    /// A point for one of the unit square, at P, whose normal on the side that is looked at is N (zero: not
    /// known). For even points of the square the mean of solid_angle times a function of where light comes
    /// from is the function's integral over the light as it is seen from P.
    virtual LightSample sample(const V3f& P, const V3f& N, const V2f& square) const = 0;

    /// How far points may lie from the surface that they stand for.
    virtual float roughness() const { return 0; }
    /// Of one side; 1 where the light is nowhere.
    virtual float area() const { return 1; }
    /// Light comes from all of its points alike: one is enough.
    virtual bool is_point() const { return false; }
};

// Each is null for a shape that has no area, or is not finite.

/// Kinds Rect and Disk.
std::unique_ptr<LightSampler> make_flat_sampler(const LightShape& shape, const M44f& camera_from_light);
std::unique_ptr<LightSampler> make_sphere_sampler(const M44f& camera_from_light);
std::unique_ptr<LightSampler> make_cylinder_sampler(const M44f& camera_from_light);
std::unique_ptr<LightSampler> make_mesh_sampler(const LightMesh& mesh, bool two_sided);
std::unique_ptr<LightSampler> make_distant_sampler(float angle, const M44f& camera_from_light);
/// Of a dome in each of some spaces, one for each. Without colours it is white. Null, too, where all of it is
/// black.
std::vector<std::unique_ptr<LightSampler>> make_dome_samplers(SkyPicture map,
                                                              std::span<const M44f> camera_from_light);

}  // namespace trapeze
