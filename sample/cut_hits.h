/// What is cut away from a scene by constructive solid geometry (RISpec 5.7) and by clipping planes: hits
/// that lie on no border of what is left are taken out of samples' lists. Resolved along each sample's ray,
/// at its time and point of the lens, it is exact with motion and defocus, and the same for all methods
/// [decision 0013].
#pragma once

#include <memory>

#include "core/scene/scene.h"
#include "sample/visibility.h"

namespace trapeze {

/// Which leaves of the trees of solids hold the point that travels along a ray, and so which roots do.
class SolidState {
  public:
    explicit SolidState(const std::vector<Solid>& solids);

    /// Outside of all.
    void reset();
    /// The ray crosses a surface of a leaf (a solid of Operation::Primitive); returns whether it thereby
    /// enters or leaves what the leaf's tree describes.
    bool cross(int leaf);

  private:
    bool holds(int solid) const;

    const std::vector<Solid>& solids_;
    std::vector<int> child_count_;   ///< of each solid
    std::vector<int> holding_;       ///< children that hold the point
    std::vector<bool> first_holds_;  ///< whether the first child does
    std::vector<bool> inside_;       ///< the solid itself does
    std::vector<int> touched_;       ///< solids to reset
};

/// A method whose hits are cut; the method itself when the scene cuts nothing away.
std::unique_ptr<Visibility> with_cuts(std::unique_ptr<Visibility> method, const RenderContext& context,
                                      const Grids& grids);

}  // namespace trapeze
