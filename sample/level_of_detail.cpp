#include "sample/level_of_detail.h"

#include <algorithm>

#include "core/random.h"

namespace trapeze {

/// Multiples of the golden ratio, of which any number in a row is spread evenly, from a place of the pixel's.
/// The shift of the pixel's is hashed, and the steps are 32-bit words that wrap around: adding the golden
/// ratio's fraction modulo 1 without a division.
float detail_number(uint32_t seed, int px, int py, int sample) {
    constexpr uint32_t kGoldenRatio = 0x9e3779b9u, kDimension = 0x6c6f64u;
    const uint32_t first = hash(seed, kDimension, static_cast<uint32_t>(px), static_cast<uint32_t>(py));
    return unit_float(first + static_cast<uint32_t>(sample) * kGoldenRatio);
}

namespace {

/// Another method's hits without those of primitives whose range of numbers the sample's is not in. Only
/// finished lists are thinned, so that a method needs to know nothing of levels; it pays for hits that are
/// then dropped. Grids in transition count as not opaque for that reason.
class DetailVisibility : public Visibility {
  public:
    DetailVisibility(std::unique_ptr<Visibility> method, const RenderContext& context, const Grids& grids)
        : method_(std::move(method)), seed_(context.seed), grids_(grids) {
        seen_.reserve(context.scene->primitives.size());
        for (const Primitive& primitive : context.scene->primitives)
            seen_.push_back(seen_numbers(*primitive.attributes));
    }

    void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                 SampleStats& stats) const override {
        method_->resolve(samples, hits, scratch, stats);
        size_t kept = 0;
        for (size_t s = 0; s < samples.size(); ++s) {
            const auto [first, last] = std::pair(hits.first[s], hits.first[s + 1]);
            hits.first[s] = static_cast<uint32_t>(kept);
            if (first == last) continue;
            const float number = number_of(samples, s);
            for (size_t i = first; i < last; ++i)
                if (const Hit hit = hits.hits[i]; sees(number, hit)) hits.hits[kept++] = hit;
        }
        hits.first[samples.size()] = static_cast<uint32_t>(kept);
        hits.hits.resize(kept);
    }
    BuildStats build_stats() const override { return method_->build_stats(); }
    bool walks_whole_lists() const override { return method_->walks_whole_lists(); }
    int tile_side() const override { return method_->tile_side(); }

  private:
    float number_of(const SampleTile& samples, size_t s) const {
        const PixelPlace pixel = samples.pixel_of(s);
        return detail_number(seed_, pixel.x, pixel.y, static_cast<int>(samples.number_in_pixel(s)));
    }

    /// A primitive outside any transition has the range of all numbers.
    bool sees(float number, const Hit& hit) const {
        return seen_[grids_.grids[MicropolygonId::unpack(hit.id).grid].primitive].contain(number);
    }

    const std::unique_ptr<Visibility> method_;
    const uint32_t seed_;
    const Grids& grids_;
    std::vector<SeenNumbers> seen_;  ///< by primitive
};

}  // namespace

/// Methods know nothing of levels of detail: where some primitive is seen by a part of the samples alone, a
/// wrapper stands before the method. Scenes without any pay nothing.
std::unique_ptr<Visibility> with_levels_of_detail(std::unique_ptr<Visibility> method,
                                                  const RenderContext& context, const Grids& grids) {
    if (!method || !context.scene) return method;
    const std::vector<Primitive>& primitives = context.scene->primitives;
    if (std::none_of(primitives.begin(), primitives.end(), [](const Primitive& primitive) {
            return primitive.attributes && !seen_numbers(*primitive.attributes).are_all();
        }))
        return method;
    return std::make_unique<DetailVisibility>(std::move(method), context, grids);
}

}  // namespace trapeze
