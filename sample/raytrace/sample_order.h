/// The order in which a method traces the samples of tiles: chosen by what is blurred where, remembered where
/// it serves again.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "sample/raytrace/blur_map.h"
#include "sample/raytrace/bundle_order.h"

namespace trapeze {

/// An order of a tile's samples. It serves again for tiles of the same kind and owner.
struct KnownOrder {
    const void* owner = nullptr;  ///< who made it
    std::array<int, 6> kind{};    ///< for what tiles, how sorted
    std::vector<uint32_t> order;
};

/// What a thread needs while it puts samples in order.
struct SampleOrderScratch {
    std::vector<KnownOrder> known;  ///< at most a few
    BundleOrderScratch sort;
};

/// Chooses and makes the orders of one method's tiles. It keeps no state of its own beyond the map of blur;
/// what it remembers is in the caller's scratch.
class SampleOrder {
  public:
    /// `motion`: samples' times matter; of the camera's lens its being there.
    SampleOrder(const Camera& camera, const Grids& grids, bool motion);

    /// Indices of samples; valid until the next call with the same scratch.
    std::span<const uint32_t> of(const SampleTile& samples, SampleOrderScratch& scratch) const;

  private:
    RayBlur blur_of_rays_;
    std::optional<BlurMap> blur_;  ///< where there is any
};

}  // namespace trapeze
