/// The order in which a method traces the samples of tiles: chosen by what is blurred where, remembered where
/// it serves again.
#pragma once

#include <optional>
#include <span>

#include "sample/raytrace/blur_map.h"
#include "sample/raytrace/bundle_order.h"

namespace trapeze {

class TileOrder {
  public:
    /// `motion`: samples' times matter; of the camera's lens its being there.
    TileOrder(const Camera& camera, const Grids& grids, bool motion);

    /// Indices of samples; valid until the next call with the same scratch.
    std::span<const uint32_t> of(const SampleTile& samples, SampleScratch& scratch) const;

  private:
    bool motion_, lens_;
    std::optional<BlurMap> blur_;  ///< where there is any
};

}  // namespace trapeze
