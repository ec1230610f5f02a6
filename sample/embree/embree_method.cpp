/// Embree as a visibility method: the reference from outside [Wald14]. The same grids and rays, in the
/// order in which raytrace takes them, which is faster for Embree too than that of [Hou10]; its own hits. Its
/// edges, depths and ties are not the predicate's: it is not among the methods that agree bit for bit, and
/// pictures differ where edges of micropolygons pass samples. Threads may break its ties either way.
///
/// Its BuildStats::setup_seconds is the time to copy grids to buffers that Embree can read. It does not say
/// what it tests and visits: those counts stay 0.
#include <algorithm>
#include <stdexcept>

#include "core/simd/simd_limit.h"
#include "sample/embree/embree_library.h"
#include "sample/hit_lists.h"
#include "sample/raytrace/tile_order.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

/// A micropolygon counts once a sample, where it is nearest: Embree may report both sides of a diagonal, and
/// what it has split more than once.
void drop_repeated(HitBuffer& hits) {
    size_t kept = 0;
    for (size_t sample = 0; sample + 1 < hits.first.size(); ++sample) {
        const size_t begin = hits.first[sample], end = hits.first[sample + 1], first_kept = kept;
        hits.first[sample] = static_cast<uint32_t>(kept);
        for (size_t i = begin; i < end; ++i) {
            const auto same = [id = hits.hits[i].id](const Hit& hit) { return hit.id == id; };
            const auto list = hits.hits.begin();
            if (std::none_of(list + static_cast<std::ptrdiff_t>(first_kept),
                             list + static_cast<std::ptrdiff_t>(kept), same))
                hits.hits[kept++] = hits.hits[i];
        }
    }
    hits.first.back() = static_cast<uint32_t>(kept);
    hits.hits.resize(kept);
}

/// The device's configuration: Embree is held to what our own vector code may use, so that both can be
/// compared. Threads are those of the calling task arena.
std::string device_config() {
    const std::string_view limit = simd_limit();
    if (limit == "sse4") return "isa=sse4.2";
    if (limit == "avx2") return "isa=avx2";
    return "";
}

/// Throws when the module cannot be opened; the method's check, which choose_sampler() asks, has said so
/// before.
std::unique_ptr<EmbreeTracer> build(const Grids& grids, const EmbreeChoices& choices) {
    std::string problem;
    const EmbreeLibrary* const library = embree_library(&problem);
    if (!library) throw std::runtime_error(problem);
    return library->build(grids, choices);
}

/// Hits that are not opaque, as Embree finds them.
struct EmbreeLayers {
    std::vector<LooseHits::Entry> entries;
};

/// Brings tiles into an order, has them traced, and makes hit lists of what comes back.
class EmbreeTraced final : public Visibility {
  public:
    EmbreeTraced(const VisibilityInput& input, const EmbreeChoices& choices)
        : order_(input.context.camera, input.grids, input.grids.max_key_count() > 1),
          all_opaque_(every_grid_is_opaque(input.grids)),
          tracer_(build(input.grids, choices)) {}

    void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                 SampleStats& stats) const override {
        const auto order = order_.of(samples, scratch.own.of<TileOrderScratch>());
        scratch.nearest.assign(samples.size(), Hit{kInfinity, MicropolygonId::kNone});
        scratch.found.begin(samples.size());
        std::vector<LooseHits::Entry>& layers = scratch.own.of<EmbreeLayers>().entries;
        layers.clear();
        tracer_->trace(samples, order, scratch, layers);
        stats.rays += samples.size();
        if (all_opaque_) {
            buffer_of_nearest(scratch, samples.size(), hits);
            return;
        }
        for (const LooseHits::Entry& entry : layers) scratch.found.add(entry.sample, entry.hit());
        // Opaque hits join the loose ones, so that one sort by depth orders both.
        for (size_t sample = 0; sample < samples.size(); ++sample) {
            if (scratch.nearest[sample].id == MicropolygonId::kNone) continue;
            scratch.found.add(static_cast<uint32_t>(sample), scratch.nearest[sample]);
        }
        buffer_of_loose_hits(scratch, samples.size(), hits);
        drop_repeated(hits);
    }

    BuildStats build_stats() const override { return tracer_->stats(); }
    /// The two triangles of a micropolygon may both be hit, at different depths.
    bool bounds_layers() const override { return false; }

  private:
    TileOrder order_;
    bool all_opaque_;
    std::unique_ptr<EmbreeTracer> tracer_;
};

EmbreeMode mode_of(std::string_view name) {
    if (name == "1") return EmbreeMode::Single;
    if (name == "8") return EmbreeMode::Packet8;
    if (name == "16") return EmbreeMode::Packet16;
    return name == "stream" ? EmbreeMode::Stream : EmbreeMode::Fastest;
}

EmbreeQuality quality_of(std::string_view name) {
    if (name == "low") return EmbreeQuality::Low;
    return name == "high" ? EmbreeQuality::High : EmbreeQuality::Medium;
}

EmbreeChoices choices_of(const VisibilityInput& input) {
    const Camera& camera = input.context.camera;
    return {input.spec["geometry"] == "quad",
            quality_of(input.spec["quality"]),
            mode_of(input.spec["mode"]),
            input.grids.max_key_count() > 1,
            device_config(),
            camera.near_clip,
            camera.far_clip};
}

}  // namespace

VisibilityMethod embree_method() {
    return {"embree",
            MethodKind::RayTracer,
            {{"geometry", {"grid", "quad"}},
             {"mode", {"auto", "1", "8", "16", "stream"}},
             {"quality", {"medium", "low", "high"}}},
            stratified_pattern,
            any_pattern,
            [](const VisibilityInput& input) -> std::unique_ptr<Visibility> {
                return std::make_unique<EmbreeTraced>(input, choices_of(input));
            },
            [](const MethodSpec&) {
                std::string problem;
                embree_library(&problem);
                return problem;
            },
            false};
}

}  // namespace trapeze
