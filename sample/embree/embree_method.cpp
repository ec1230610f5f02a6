/// Embree as a visibility method: the reference from outside [Wald14]. The same grids and rays, in the
/// order in which raytrace takes them, which is faster for Embree too than that of [Hou10]; its own hits. Its
/// edges, depths and ties are not the predicate's: it is not among the methods that agree bit for bit, and
/// pictures differ where edges of micropolygons pass samples. Threads may break its ties either way.
///
/// Its BuildStats::setup_seconds is the time to copy grids to buffers that Embree can read. It does not say
/// what it tests and visits: those counts stay 0.
#include <algorithm>
#include <cmath>

#include "sample/embree/embree_scene.h"
#include "sample/hit_lists.h"
#include "sample/raytrace/tile_order.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

/// Rays of a stream: enough to fill Embree's packets, small enough for the first cache.
constexpr size_t kStreamRays = 256;

/// What filters find in the context of a call.
struct Collector {
    RTCIntersectContext context;  // first: Embree hands its address on
    SampleScratch* scratch;
};

bool faces(const Grid& grid, const RTCFilterFunctionNArguments& args, unsigned i) {
    if (grid.facing == Facing::Both) return true;
    const float along = RTCHitN_Ng_x(args.hit, args.N, i) * RTCRayN_dir_x(args.ray, args.N, i) +
                        RTCHitN_Ng_y(args.hit, args.N, i) * RTCRayN_dir_y(args.ray, args.N, i) +
                        RTCHitN_Ng_z(args.hit, args.N, i) * RTCRayN_dir_z(args.ray, args.N, i);
    return (grid.facing == Facing::PositiveOnly) == (along <= 0);
}

/// Rejects hits on the side that does not show; notes transparent ones and lets the ray go on.
void filter_hits(const RTCFilterFunctionNArguments* args) {
    const auto& mesh = *static_cast<const EmbreeMesh*>(args->geometryUserPtr);
    SampleScratch& scratch = *reinterpret_cast<Collector*>(args->context)->scratch;
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        const unsigned primitive = RTCHitN_primID(args->hit, args->N, i);
        const uint64_t id = EmbreeScene::micropolygon(mesh, primitive, RTCHitN_u(args->hit, args->N, i),
                                                      RTCHitN_v(args->hit, args->N, i));
        const Grid& grid = mesh.all_grids->grids[MicropolygonId::unpack(id).grid];
        if (grid.opaque && faces(grid, *args, i)) continue;
        args->valid[i] = 0;
        if (!faces(grid, *args, i)) continue;
        scratch.hits.push_back({RTCRayN_tfar(args->ray, args->N, i), id});
        scratch.hit_sample.push_back(RTCRayN_id(args->ray, args->N, i));
    }
}

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

enum class Mode { Fastest, Single, Packet8, Packet16, Stream };

/// As tests/bench/trace_bench measures: streams, which Embree turns into packets of its own, are the fastest
/// everywhere with quads; with grids that is so for packets of 16 without motion, and packets of 8 are else.
Mode chosen_mode(Mode asked, const EmbreeScene& scene, bool quads, bool motion) {
    if (asked != Mode::Fastest) return asked;
    return quads || (scene.has_wide_packets() && !motion) ? Mode::Stream : Mode::Packet8;
}

class EmbreeTraced final : public Visibility {
  public:
    EmbreeTraced(const VisibilityInput& input, const EmbreeChoices& choices, Mode mode)
        : order_(input.context.camera, input.grids, input.grids.max_key_count() > 1),
          all_opaque_(every_grid_is_opaque(input.grids)),
          // Embree's range is open at its near end, ours is closed.
          near_(std::nextafter(input.context.camera.near_clip, -kInfinity)),
          far_(input.context.camera.far_clip),
          scene_(input.grids, choices),
          mode_(chosen_mode(mode, scene_, choices.quads, input.grids.max_key_count() > 1)) {}

    void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                 SampleStats& stats) const override {
        const auto order = order_.of(samples, scratch.own.of<TileOrderScratch>());
        scratch.nearest.assign(samples.size(), Hit{kInfinity, MicropolygonId::kNone});
        scratch.hits.clear();
        scratch.hit_sample.clear();
        trace(samples, order, scratch);
        stats.rays += samples.size();
        if (all_opaque_) {
            buffer_of_nearest(scratch, samples.size(), hits);
            return;
        }
        for (size_t sample = 0; sample < samples.size(); ++sample) {
            if (scratch.nearest[sample].id == MicropolygonId::kNone) continue;
            scratch.hits.push_back(scratch.nearest[sample]);
            scratch.hit_sample.push_back(static_cast<uint32_t>(sample));
        }
        buffer_of_loose_hits(scratch, samples.size(), hits);
        drop_repeated(hits);
    }

    BuildStats build_stats() const override { return scene_.stats(); }

  private:
    void trace(const SampleTile& samples, std::span<const uint32_t> order, SampleScratch& scratch) const {
        Collector collector;
        rtcInitIntersectContext(&collector.context);
        collector.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        collector.scratch = &scratch;
        switch (mode_) {
            case Mode::Single:
                return trace_singly(samples, order, scratch, &collector.context);
            case Mode::Packet8:
                return trace_packets<8, RTCRayHit8>(samples, order, scratch, &collector.context,
                                                    rtcIntersect8);
            case Mode::Packet16:
                return trace_packets<16, RTCRayHit16>(samples, order, scratch, &collector.context,
                                                      rtcIntersect16);
            default:
                return trace_streams(samples, order, scratch, &collector.context);
        }
    }

    void set_ray(const AxisRay& from, uint32_t sample, RTCRayHit& to) const {
        to.ray.org_x = from.ox, to.ray.org_y = from.oy, to.ray.org_z = from.oz;
        to.ray.dir_x = from.ux, to.ray.dir_y = from.uy, to.ray.dir_z = 1;  // distance is camera-space z
        to.ray.tnear = near_, to.ray.tfar = far_, to.ray.time = from.time;
        to.ray.mask = ~0u, to.ray.id = sample, to.ray.flags = 0;
        to.hit.geomID = to.hit.primID = to.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    void keep(const RTCRayHit& ray, uint32_t sample, SampleScratch& scratch) const {
        if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
        scratch.nearest[sample] = {ray.ray.tfar,
                                   scene_.micropolygon(ray.hit.geomID, ray.hit.primID, ray.hit.u, ray.hit.v)};
    }

    void trace_singly(const SampleTile& samples, std::span<const uint32_t> order, SampleScratch& scratch,
                      RTCIntersectContext* context) const {
        RTCRayHit ray;
        for (const uint32_t sample : order) {
            set_ray(samples.rays[sample], sample, ray);
            rtcIntersect1(scene_.scene(), context, &ray);
            keep(ray, sample, scratch);
        }
    }

    void trace_streams(const SampleTile& samples, std::span<const uint32_t> order, SampleScratch& scratch,
                       RTCIntersectContext* context) const {
        RTCRayHit rays[kStreamRays];
        for (size_t first = 0; first < order.size(); first += kStreamRays) {
            const size_t count = std::min(kStreamRays, order.size() - first);
            for (size_t i = 0; i < count; ++i)
                set_ray(samples.rays[order[first + i]], order[first + i], rays[i]);
            rtcIntersect1M(scene_.scene(), context, rays, static_cast<unsigned>(count), sizeof(RTCRayHit));
            for (size_t i = 0; i < count; ++i) keep(rays[i], order[first + i], scratch);
        }
    }

    template <size_t kLanes, class Packet, class Intersect>
    void trace_packets(const SampleTile& samples, std::span<const uint32_t> order, SampleScratch& scratch,
                       RTCIntersectContext* context, Intersect intersect) const {
        Packet packet;
        alignas(64) int valid[kLanes];
        for (size_t first = 0; first < order.size(); first += kLanes) {
            const size_t count = std::min(kLanes, order.size() - first);
            for (size_t lane = 0; lane < kLanes; ++lane) {
                const uint32_t sample = order[first + std::min(lane, count - 1)];
                valid[lane] = lane < count ? -1 : 0;
                set_lane(samples.rays[sample], sample, lane, packet);
            }
            intersect(valid, scene_.scene(), context, &packet);
            for (size_t lane = 0; lane < count; ++lane)
                if (packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID)
                    scratch.nearest[order[first + lane]] = {
                        packet.ray.tfar[lane],
                        scene_.micropolygon(packet.hit.geomID[lane], packet.hit.primID[lane],
                                            packet.hit.u[lane], packet.hit.v[lane])};
        }
    }
    template <class Packet>
    void set_lane(const AxisRay& from, uint32_t sample, size_t lane, Packet& to) const {
        to.ray.org_x[lane] = from.ox, to.ray.org_y[lane] = from.oy, to.ray.org_z[lane] = from.oz;
        to.ray.dir_x[lane] = from.ux, to.ray.dir_y[lane] = from.uy, to.ray.dir_z[lane] = 1;
        to.ray.tnear[lane] = near_, to.ray.tfar[lane] = far_, to.ray.time[lane] = from.time;
        to.ray.mask[lane] = ~0u, to.ray.id[lane] = sample, to.ray.flags[lane] = 0;
        to.hit.geomID[lane] = to.hit.primID[lane] = to.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }

    TileOrder order_;
    bool all_opaque_;
    float near_, far_;
    EmbreeScene scene_;
    Mode mode_;
};

Mode mode_of(std::string_view name) {
    if (name == "1") return Mode::Single;
    if (name == "8") return Mode::Packet8;
    if (name == "16") return Mode::Packet16;
    return name == "stream" ? Mode::Stream : Mode::Fastest;
}

RTCBuildQuality quality_of(std::string_view name) {
    if (name == "low") return RTC_BUILD_QUALITY_LOW;
    return name == "high" ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
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
                const EmbreeChoices choices{input.spec["geometry"] == "quad",
                                            quality_of(input.spec["quality"]), filter_hits};
                return std::make_unique<EmbreeTraced>(input, choices, mode_of(input.spec["mode"]));
            }};
}

}  // namespace trapeze
