#include "sample/raytrace/sample_order.h"

namespace trapeze {
namespace {

/// Remembered at once, of whatever kinds.
constexpr size_t kMostOrders = 32;

}  // namespace

/// Without blur there is nothing to weigh, and rays go pixel by pixel.
SampleOrder::SampleOrder(const Camera& camera, const Grids& grids, bool motion)
    : blur_of_rays_{motion, camera.has_lens()} {
    if (blur_of_rays_.lens || blur_of_rays_.motion) blur_.emplace(camera, grids);
}

/// The span holds until the next call with the same scratch. Orders known from another SampleOrder are
/// dropped. Orders change how long tracing takes, and no hit.
std::span<const uint32_t> SampleOrder::of(const SampleTile& samples, SampleOrderScratch& scratch) const {
    BundleOrder order;
    if (blur_) order = best_order(blur_->at(samples.pixels), samples.samples_per_pixel, blur_of_rays_);
    const std::array kind{samples.pixels.width(), samples.pixels.height(), samples.samples_per_pixel,
                          order.block_side,       order.lens_bits,         order.time_bits};
    std::vector<KnownOrder>& known = scratch.known;
    if (!known.empty() && known.front().owner != this) known.clear();
    // Through a lens alone, or a pinhole, an order serves all tiles of the same shape that are sorted alike:
    // strata of the lens are the same in all pixels (where a pattern's are not, it is only less good). Lists
    // have each their own.
    const bool serves_again = !blur_of_rays_.motion && !samples.is_list();
    if (serves_again)
        for (const KnownOrder& one : known)
            if (one.kind == kind) return one.order;
    if (known.empty() || (serves_again && known.size() < kMostOrders)) known.emplace_back();
    KnownOrder& made = known.back();
    made.owner = this, made.kind = samples.is_list() ? std::array<int, 6>{} : kind;
    order_bundles(samples, blur_of_rays_, order, scratch.sort, made.order);
    return made.order;
}

}  // namespace trapeze
