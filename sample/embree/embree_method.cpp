/// Embree as a visibility method: the reference from outside [Wald14]. The same grids and rays, in the
/// order in which raytrace takes them, which is faster for Embree too than that of [Hou10]; its own hits. Its
/// edges, depths and ties are not the predicate's: it is not among the methods that agree bit for bit, and
/// pictures differ where edges of micropolygons pass samples. Threads may break its ties either way.
///
/// Its BuildStats::setup_seconds is the time to copy grids to buffers that Embree can read. It does not say
/// what it tests and visits: those counts stay 0.
#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "sample/embree/embree_library.h"
#include "sample/hit_lists.h"
#include "sample/raytrace/sample_order.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

/// Rays that fill a packet. Layers of the rays that are traced together take this share of the room.
constexpr size_t kLeastRays = 16, kLayersShare = 8;

/// A micropolygon counts once a sample, where it is nearest: Embree may report both sides of a diagonal, and
/// what it has split more than once.
void drop_repeated(std::vector<LooseHits::Entry>& entries) {
    using Entry = LooseHits::Entry;
    std::ranges::sort(entries, {}, [](const Entry& e) { return std::tuple(e.sample, e.id, e.depth); });
    const auto same = [](const Entry& a, const Entry& b) { return a.sample == b.sample && a.id == b.id; };
    entries.erase(std::unique(entries.begin(), entries.end(), same), entries.end());
}

/// Throws when the module cannot be opened; the method's check, which choose_sampler() asks, has said so
/// before.
std::unique_ptr<EmbreeTracer> build(const Grids& grids, const EmbreeChoices& choices) {
    std::string problem;
    const EmbreeLibrary* const library = embree_library(&problem);
    if (!library) throw std::runtime_error(problem);
    return library->build(grids, choices);
}

/// A thread's memory for this method, found through SampleScratch::own.
struct EmbreeOwn {
    std::vector<uint32_t> wanted;          ///< samples
    std::vector<LooseHits::Entry> layers;  ///< hits of some rays that are not opaque, as Embree finds them
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
        auto& own = scratch.own.of<EmbreeOwn>();
        own.wanted.clear();
        for (const uint32_t sample : order_.of(samples, scratch.own.of<SampleOrderScratch>()))
            if (scratch.window.wants(sample)) own.wanted.push_back(sample);
        scratch.nearest.assign(samples.size(), Hit{kInfinity, MicropolygonId::kNone});
        stats.rays += own.wanted.size();
        if (all_opaque_) {
            own.layers.clear();
            tracer_->trace(samples, own.wanted, scratch, own.layers);
            return buffer_of_nearest(scratch, samples.size(), hits);
        }
        scratch.found.begin(samples.size(), scratch.window);
        const std::span<const uint32_t> wanted(own.wanted);
        for (size_t first = 0, count = kLeastRays; first < wanted.size();) {
            const auto some = wanted.subspan(first, std::min(count, wanted.size() - first));
            trace_layers(samples, some, scratch, own.layers);
            first += some.size();
            // As many rays as have room for what the last ones have crossed.
            const size_t crossed = own.layers.size() / some.size() + 1;
            count = std::max(kLeastRays, scratch.window.room / kLayersShare / crossed);
        }
        scratch.own_list_bytes = own.layers.capacity() * sizeof(LooseHits::Entry);
        buffer_of_loose_hits(scratch, samples.size(), hits);
    }

    BuildStats build_stats() const override { return tracer_->stats(); }
    bool walks_whole_lists() const override { return true; }

  private:
    /// Whole lists of some rays, of which what is wanted is kept. Opaque hits join the loose ones, so that
    /// one sort by depth orders both.
    void trace_layers(const SampleTile& samples, std::span<const uint32_t> rays, SampleScratch& scratch,
                      std::vector<LooseHits::Entry>& layers) const {
        layers.clear();
        tracer_->trace(samples, rays, scratch, layers);
        drop_repeated(layers);
        for (const LooseHits::Entry& entry : layers) scratch.found.add(entry.sample, entry.hit());
        for (const uint32_t sample : rays)
            if (scratch.nearest[sample].id != MicropolygonId::kNone)
                scratch.found.add(sample, scratch.nearest[sample]);
    }

    SampleOrder order_;
    bool all_opaque_;
    std::unique_ptr<EmbreeTracer> tracer_;
};

/// The words have been checked against the table's values: what is left over is "auto".
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

/// The planes of clipping are limits of Embree's rays, so that no hit outside of them has to be refused
/// later.
EmbreeChoices choices_of(const VisibilityInput& input) {
    const Camera& camera = input.context.camera;
    return {input.spec["geometry"] == "quad",
            quality_of(input.spec["quality"]),
            mode_of(input.spec["mode"]),
            input.grids.max_key_count() > 1,
            embree_device(),
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
            false,
            true};
}

}  // namespace trapeze
