/// The module "embree": rays traced by Embree.
#include <algorithm>
#include <cmath>

#include "sample/embree/embree_library.h"
#include "sample/embree/embree_scene.h"

namespace trapeze {
namespace {

/// Rays of a stream: enough to fill Embree's packets, small enough for the first cache.
constexpr size_t kStreamRays = 256;

/// What filters find in the context of a call.
struct Collector {
    RTCIntersectContext context;  // first: Embree hands its address on
    std::vector<LooseHits::Entry>* layers;
};

/// Whether the side that the ray meets is to be seen: by the sign of normal times direction.
bool faces(const Grid& grid, const RTCFilterFunctionNArguments& args, unsigned i) {
    if (grid.facing == Facing::Both) return true;
    const float along = RTCHitN_Ng_x(args.hit, args.N, i) * RTCRayN_dir_x(args.ray, args.N, i) +
                        RTCHitN_Ng_y(args.hit, args.N, i) * RTCRayN_dir_y(args.ray, args.N, i) +
                        RTCHitN_Ng_z(args.hit, args.N, i) * RTCRayN_dir_z(args.ray, args.N, i);
    return (grid.facing == Facing::PositiveOnly) == (along <= 0);
}

/// Rejects hits on the side that does not show; notes transparent ones and lets the ray go on. Called by
/// Embree for each hit that it finds, in no order of depth: a transparent layer behind an opaque hit is noted
/// too, and sorted out later.
void filter_hits(const RTCFilterFunctionNArguments* args) {
    const auto& mesh = *static_cast<const EmbreeMesh*>(args->geometryUserPtr);
    std::vector<LooseHits::Entry>& layers = *reinterpret_cast<Collector*>(args->context)->layers;
    for (unsigned i = 0; i < args->N; ++i) {
        // Embree's masks: -1 is a lane with a hit, 0 one without; setting 0 rejects the hit.
        if (args->valid[i] != -1) continue;
        const unsigned primitive = RTCHitN_primID(args->hit, args->N, i);
        const uint64_t id = EmbreeScene::micropolygon(mesh, primitive, RTCHitN_u(args->hit, args->N, i),
                                                      RTCHitN_v(args->hit, args->N, i));
        const Grid& grid = mesh.all_grids->grids[MicropolygonId::unpack(id).grid];
        if (grid.opaque && faces(grid, *args, i)) continue;
        args->valid[i] = 0;
        if (!faces(grid, *args, i)) continue;
        layers.push_back({RTCRayN_tfar(args->ray, args->N, i), RTCRayN_id(args->ray, args->N, i), id});
    }
}

/// As tests/bench/trace_bench measures: streams, which Embree turns into packets of its own, are the fastest
/// everywhere with quads; with grids that is so for packets of 16 without motion, and packets of 8 are else.
EmbreeMode chosen_mode(EmbreeMode asked, const EmbreeScene& scene, bool quads, bool motion) {
    if (asked != EmbreeMode::Fastest) return asked;
    return quads || (scene.has_wide_packets() && !motion) ? EmbreeMode::Stream : EmbreeMode::Packet8;
}

/// The tree and the way in which rays are handed to it. Immutable once made; every call of trace() has a
/// context of its own, through which the filter finds that call's list.
class Tracer final : public EmbreeTracer {
  public:
    Tracer(const Grids& grids, const EmbreeChoices& choices)
        :  // Embree's range is open at its near end, ours is closed.
          near_(std::nextafter(choices.near_clip, -kInfinity)),
          far_(choices.far_clip),
          scene_(grids, choices, filter_hits),
          mode_(chosen_mode(choices.mode, scene_, choices.quads, choices.motion)) {}

    const BuildStats& stats() const override { return scene_.stats(); }

    void trace(const SampleTile& samples, std::span<const uint32_t> order, SampleScratch& scratch,
               std::vector<LooseHits::Entry>& layers) const override {
        Collector collector;
        rtcInitIntersectContext(&collector.context);
        collector.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        collector.layers = &layers;
        switch (mode_) {
            case EmbreeMode::Single:
                return trace_singly(samples, order, scratch, &collector.context);
            case EmbreeMode::Packet8:
                return trace_packets<8, RTCRayHit8>(samples, order, scratch, &collector.context,
                                                    rtcIntersect8);
            case EmbreeMode::Packet16:
                return trace_packets<16, RTCRayHit16>(samples, order, scratch, &collector.context,
                                                      rtcIntersect16);
            default:
                return trace_streams(samples, order, scratch, &collector.context);
        }
    }

  private:
    /// A ray with direction z of 1, so that the distance along it is camera-space depth.
    void set_ray(const AxisRay& from, uint32_t sample, RTCRayHit& to) const {
        to.ray.org_x = from.ox, to.ray.org_y = from.oy, to.ray.org_z = from.oz;
        to.ray.dir_x = from.ux, to.ray.dir_y = from.uy, to.ray.dir_z = 1;  // distance is camera-space z
        to.ray.tnear = near_, to.ray.tfar = far_, to.ray.time = from.time;
        to.ray.mask = ~0u, to.ray.id = sample, to.ray.flags = 0;
        to.hit.geomID = to.hit.primID = to.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    /// What Embree reports at last is the nearest hit that no filter rejected: opaque, and on a side that
    /// shows.
    void keep(const RTCRayHit& ray, uint32_t sample, SampleScratch& scratch) const {
        if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
        scratch.nearest[sample] = {ray.ray.tfar,
                                   scene_.micropolygon(ray.hit.geomID, ray.hit.primID, ray.hit.u, ray.hit.v)};
    }

    /// A call for each ray.
    void trace_singly(const SampleTile& samples, std::span<const uint32_t> order, SampleScratch& scratch,
                      RTCIntersectContext* context) const {
        RTCRayHit ray;
        for (const uint32_t sample : order) {
            set_ray(samples.rays[sample], sample, ray);
            rtcIntersect1(scene_.scene(), context, &ray);
            keep(ray, sample, scratch);
        }
    }

    /// Rays as structures one after the other, which Embree sorts into packets itself.
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

    /// kLanes rays a call. The last packet is filled up with copies of its last ray, which are masked off.
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
    /// As set_ray(), in one lane of a packet, whose numbers lie in planes.
    template <class Packet>
    void set_lane(const AxisRay& from, uint32_t sample, size_t lane, Packet& to) const {
        to.ray.org_x[lane] = from.ox, to.ray.org_y[lane] = from.oy, to.ray.org_z[lane] = from.oz;
        to.ray.dir_x[lane] = from.ux, to.ray.dir_y[lane] = from.uy, to.ray.dir_z[lane] = 1;
        to.ray.tnear[lane] = near_, to.ray.tfar[lane] = far_, to.ray.time[lane] = from.time;
        to.ray.mask[lane] = ~0u, to.ray.id[lane] = sample, to.ray.flags[lane] = 0;
        to.hit.geomID[lane] = to.hit.primID[lane] = to.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }

    float near_, far_;
    EmbreeScene scene_;
    EmbreeMode mode_;
};

/// The one object of the module, handed out through trapeze_embree_module.
class Library final : public EmbreeLibrary {
  public:
    std::unique_ptr<EmbreeTracer> build(const Grids& grids, const EmbreeChoices& choices) const override {
        return std::make_unique<Tracer>(grids, choices);
    }
};

constexpr Library kLibrary;

}  // namespace
}  // namespace trapeze

const trapeze::ModuleEntry trapeze_embree_module = {
    TRAPEZE_VERSION, static_cast<const trapeze::EmbreeLibrary*>(&trapeze::kLibrary)};
