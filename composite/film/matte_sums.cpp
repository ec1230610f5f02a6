#include "composite/film/matte_sums.h"

#include <algorithm>
#include <bit>

namespace trapeze {

void MatteSums::add(const FilterTaps& taps, const FilterKernel& kernel, const float* weights, float times,
                    std::span<const MatteCoverage> sample) {
    for (int j = 0; j < kernel.taps_y(); ++j)
        for (int i = 0; i < kernel.taps_x(); ++i) {
            const float weight = times * weights[j * kernel.taps_x() + i];
            if (weight == 0) continue;
            MattePixel& pixel = sums_[index(taps.x0 + i, taps.y0 + j)];
            pixel.weight += weight;
            for (const MatteCoverage& coverage : sample) pixel.add(coverage.key, weight * coverage.weight);
        }
}

size_t MatteSums::bytes() const {
    size_t coverages = 0;
    for (const MattePixel& pixel : sums_) coverages += pixel.coverages.capacity();
    return sums_.size() * sizeof(MattePixel) + coverages * sizeof(MatteCoverage);
}

float rank_mattes(const MattePixel& pixel, const MatteKeys& keys, float* ranks) {
    struct Ranked {
        float id, coverage;
    };
    const auto comes_before = [](const Ranked& a, const Ranked& b) {
        if (a.coverage != b.coverage) return a.coverage > b.coverage;
        return std::bit_cast<uint32_t>(a.id) < std::bit_cast<uint32_t>(b.id);
    };
    float lost = 0;
    std::vector<Ranked> ranked;
    for (size_t layer = 0; layer < keys.layer_count(); ++layer, ranks += kMatteFloats) {
        std::fill_n(ranks, kMatteFloats, 0.0f);
        ranked.clear();
        for (const MatteCoverage& coverage : pixel.coverages) {
            const float id = keys.id(coverage.key, layer);
            const auto known =
                std::ranges::find_if(ranked, [id](const Ranked& other) { return other.id == id; });
            if (known == ranked.end())
                ranked.push_back({id, coverage.weight});
            else
                known->coverage += coverage.weight;
        }
        std::ranges::sort(ranked, comes_before);
        float left_out = 0;
        for (size_t rank = 0; rank < ranked.size(); ++rank) {
            const float share = pixel.weight == 0 ? 0 : ranked[rank].coverage / pixel.weight;
            if (rank >= kMatteRanks)
                left_out += share;
            else if (share > 0)
                ranks[2 * rank] = ranked[rank].id, ranks[2 * rank + 1] = share;
        }
        lost = std::max(lost, left_out);
    }
    return lost;
}

}  // namespace trapeze
