/// Rays as shaders send them, in any direction, on one thread: towards a light, mirrored, and over the
/// hemispheres of points; still and moving. Through the wide tree, through its scalar twin, and through
/// Embree where it is there, ray by ray and as streams. All answer the same rays; "hits/ray" tells that they
/// agree. `--simd NAME` limits the instruction set, Embree's, too.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "accel/wide/rays/scalar_ray_harness.h"
#include "accel/wide/rays/single_ray.h"
#include "accel/wide/wide_tree.h"
#include "sampling_scenes.h"
#include "tests/bench/run_benchmarks.h"
#ifdef TRAPEZE_HAVE_EMBREE
#include "sample/embree/embree_scene.h"
#endif

namespace trapeze {
namespace {

using testing::SamplingScene;
using testing::ScalarRay;

/// A ray and the depths of it that count.
struct Query {
    SpaceRay ray;
    DepthRange range;
};

/// Rays that are asked for in one call, where a tracer takes many: as many as shading has at a time.
constexpr size_t kAtOnce = 16384;

/// What rays are for. Occlusion asks whether they hit anything, indirect light and mirrors what.
enum class Kind : int { Shadow, Mirror, Occlusion, Indirect };

struct NamedKind {
    Kind kind;
    const char* name;
};
constexpr NamedKind kKinds[] = {{Kind::Shadow, "shadow"},
                                {Kind::Mirror, "mirror"},
                                {Kind::Occlusion, "occlusion"},
                                {Kind::Indirect, "indirect"}};
constexpr bool asks_any(Kind kind) {
    return kind == Kind::Shadow || kind == Kind::Occlusion;
}

constexpr int kRaysOfPoint = 64;  ///< over a hemisphere; other kinds send one ray from more points

/// The scene of the sampling benchmarks, and rays from points of its surfaces as shading comes to them: grid
/// by grid.
class RayScene {
  public:
    explicit RayScene(bool moves)
        : scene_({.micropolygons = 1.5e6, .motion_pixels = moves ? 60.0f : 0.0f}), tree_(grids(), {}) {}

    const Grids& grids() const { return scene_.maker.grids(); }
    const WideTree& tree() const { return tree_; }

    std::vector<Query> rays(Kind kind) {
        constexpr size_t kPointsOfGrid = kPointsAlong * kPointsAlong;
        const bool hemisphere = kind == Kind::Occlusion || kind == Kind::Indirect;
        const size_t points = hemisphere ? 2048 : 65536,
                     step = std::max<size_t>(1, grids().grids.size() * kPointsOfGrid / points);
        engine_.seed(11);
        std::vector<Query> queries;
        for (size_t g = 0; g < grids().grids.size(); g += step)
            for (int p = 0; p < kPointsAlong * kPointsAlong; ++p)
                add_rays(kind, grids().grids[g], p % kPointsAlong, p / kPointsAlong, queries);
        return queries;
    }

  private:
    /// Points of a grid along u and v: next to each other, as shading has them.
    static constexpr int kPointsAlong = 8;

    float random(float from, float to) {
        return from + (to - from) * static_cast<float>(engine_()) * 0x1p-32f;
    }

    /// Of vertex (u, v), or the last one but one where there are fewer.
    void add_rays(Kind kind, const Grid& grid, int u, int v, std::vector<Query>& queries) {
        u = std::min(u, grid.shape.nu - 1), v = std::min(v, grid.shape.nv - 1);
        const float time = grid.moves() ? random(0, 1) : 0.0f;
        const V3f at = grid.vertex(u, v, time), along_u = grid.vertex(u + 1, v, time) - at,
                  along_v = grid.vertex(u, v + 1, time) - at;
        V3f normal = along_u.cross(along_v).normalized();
        if (normal.dot(at) > 0) normal = -normal;  // towards the camera
        const V3f origin = at + normal * (0.1f * along_u.length());
        if (kind == Kind::Mirror) {
            const V3f in = at.normalized();
            queries.push_back({{origin, in - normal * (2 * in.dot(normal)), time}, {}});
        } else if (kind == Kind::Shadow) {
            const V3f to = V3f(20, 30, -10) - origin;
            const float whole = std::max({std::abs(to.x), std::abs(to.y), std::abs(to.z)});
            queries.push_back({{origin, to, time}, {0, whole}});
        } else {
            for (int i = 0; i < kRaysOfPoint; ++i) {
                V3f out;
                do out = {random(-1, 1), random(-1, 1), random(-1, 1)};
                while (out.length2() > 1 || out.dot(normal) <= 0);
                queries.push_back({{origin, out.normalized(), time}, {}});
            }
        }
    }

    SamplingScene scene_;
    WideTree tree_;
    std::mt19937 engine_;
};

/// Made when it is first asked for, and kept.
RayScene& scene_of(bool moves) {
    static std::unique_ptr<RayScene> scenes[2];
    if (!scenes[moves]) scenes[moves] = std::make_unique<RayScene>(moves);
    return *scenes[moves];
}

/// How many of some rays a tracer says yes of, asked one by one.
template <class Ask>
size_t count_of(std::span<const Query> queries, const Ask& ask) {
    size_t hits = 0;
    for (const Query& query : queries) hits += ask(query);
    return hits;
}

/// Tracers under one signature: bytes(), and how many rays hit, any() and closest().
class Wide {
  public:
    explicit Wide(const RayScene& scene, bool) : tree_(scene.tree()) {}
    uint64_t bytes() const { return tree_.stats().tree_bytes; }
    size_t any(std::span<const Query> queries) const {
        return count_of(queries, [&](const Query& query) { return tree_.any(query.ray, query.range); });
    }
    size_t closest(std::span<const Query> queries) const {
        return count_of(
            queries, [&](const Query& query) { return tree_.closest(query.ray, query.range).has_value(); });
    }

  private:
    const WideTree& tree_;
};

/// The same, of many rays in one call: whether they hit anything.
class WideTogether {
  public:
    explicit WideTogether(const RayScene& scene, bool) : tree_(scene.tree()) {}
    uint64_t bytes() const { return tree_.stats().tree_bytes; }
    size_t any(std::span<const Query> queries) const {
        std::vector<InTheWay> met(queries.size());
        tree_.in_the_way(ranged(queries), met);
        return queries.size() - static_cast<size_t>(std::ranges::count(met, InTheWay::Nothing));
    }

  private:
    static std::vector<RangedRay> ranged(std::span<const Query> queries) {
        std::vector<RangedRay> rays;
        for (const Query& query : queries) rays.push_back({.ray = query.ray, .range = query.range});
        return rays;
    }

    const WideTree& tree_;
};

class Scalar {
  public:
    explicit Scalar(const RayScene& scene, bool) : tree_(scene.tree()) {}
    uint64_t bytes() const { return tree_.stats().tree_bytes; }
    size_t any(std::span<const Query> queries) const {
        return count_of(queries, [&](const Query& query) {
            return ScalarRay<AnyHit>::traced(tree_, query.ray, query.range).found;
        });
    }
    size_t closest(std::span<const Query> queries) const {
        return count_of(queries, [&](const Query& query) {
            return ScalarRay<ClosestHit>::traced(tree_, query.ray, query.range).found();
        });
    }

  private:
    const WideTree& tree_;
};

#ifdef TRAPEZE_HAVE_EMBREE
/// Its own two geometries for micropolygons. kStream: many rays in one call.
template <bool kQuads, bool kStream>
class Embree {
  public:
    explicit Embree(const RayScene& scene, bool moves) : scene_(scene_of(scene, moves)) {}
    uint64_t bytes() const { return scene_.stats().tree_bytes; }
    size_t any(std::span<const Query> queries) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        static RTCRay rays[kAtOnce];
        size_t hits = 0;
        for (size_t i = 0; i < queries.size(); ++i) {
            set_ray(queries[i], rays[i]);
            if (kStream) continue;
            rtcOccluded1(scene_.scene(), &context, rays + i);
        }
        if (kStream)
            rtcOccluded1M(scene_.scene(), &context, rays, static_cast<unsigned>(queries.size()),
                          sizeof *rays);
        for (size_t i = 0; i < queries.size(); ++i) hits += rays[i].tfar < 0;
        return hits;
    }
    size_t closest(std::span<const Query> queries) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        static RTCRayHit rays[kAtOnce];
        size_t hits = 0;
        for (size_t i = 0; i < queries.size(); ++i) {
            set_ray(queries[i], rays[i].ray);
            RTCHit& hit = rays[i].hit;
            hit.geomID = hit.primID = hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            if (kStream) continue;
            rtcIntersect1(scene_.scene(), &context, rays + i);
        }
        if (kStream)
            rtcIntersect1M(scene_.scene(), &context, rays, static_cast<unsigned>(queries.size()),
                           sizeof *rays);
        for (size_t i = 0; i < queries.size(); ++i) hits += rays[i].hit.geomID != RTC_INVALID_GEOMETRY_ID;
        return hits;
    }

  private:
    /// Built once for each scene, and kept.
    static const EmbreeScene& scene_of(const RayScene& scene, bool moves) {
        static std::unique_ptr<EmbreeScene> scenes[2];
        if (!scenes[moves]) {
            EmbreeChoices choices;
            choices.quads = kQuads, choices.motion = moves, choices.device = embree_device();
            scenes[moves] = std::make_unique<EmbreeScene>(scene.grids(), choices, nullptr);
        }
        return *scenes[moves];
    }
    static void set_ray(const Query& query, RTCRay& to) {
        const V3f& o = query.ray.origin;
        const V3f& d = query.ray.direction;
        const float depth = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});  // of one length
        to.org_x = o.x, to.org_y = o.y, to.org_z = o.z;
        to.dir_x = d.x, to.dir_y = d.y, to.dir_z = d.z;
        to.tnear = query.range.min / depth, to.tfar = query.range.max / depth;
        to.time = query.ray.time, to.mask = ~0u, to.id = 0, to.flags = 0;
    }

    const EmbreeScene& scene_;
};
#endif

std::string named(const NamedKind& kind, bool moves, const char* what) {
    return std::string(kind.name) + (moves ? "/moving/" : "/still/") + what;
}

template <class Tracer>
constexpr bool kFindsClosest = requires(const Tracer& tracer, std::span<const Query> queries) {
    tracer.closest(queries);
};

template <class Tracer>
void trace(benchmark::State& state, Kind kind, bool moves) {
    RayScene& scene = scene_of(moves);
    const std::vector<Query> queries = scene.rays(kind);
    const Tracer tracer(scene, moves);
    size_t rays = 0, hits = 0;
    for (auto _ : state) {
        for (auto left = std::span(queries); !left.empty();
             left = left.subspan(std::min(left.size(), kAtOnce))) {
            const auto some = left.first(std::min(left.size(), kAtOnce));
            if constexpr (kFindsClosest<Tracer>)
                hits += asks_any(kind) ? tracer.any(some) : tracer.closest(some);
            else
                hits += tracer.any(some);
        }
        rays += queries.size();
    }
    state.counters["rays/s"] = benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsRate);
    state.counters["hits/ray"] = static_cast<double>(hits) / static_cast<double>(rays);
    state.counters["bytes/mp"] =
        static_cast<double>(tracer.bytes()) / static_cast<double>(scene.grids().micropolygon_count());
}

/// How many things a ray looks at; exact, whatever the machine.
void count(benchmark::State& state, Kind kind, bool moves) {
    RayScene& scene = scene_of(moves);
    const std::vector<Query> queries = scene.rays(kind);
    SingleRayCounts counts;
    for (auto _ : state)
        for (const auto& [ray, range] : queries)
            if (asks_any(kind))
                any_hit(scene.tree(), ray, range, &counts);
            else
                closest_hit(scene.tree(), ray, range, &counts);
    const auto rays = static_cast<double>(queries.size());
    state.counters["nodes/ray"] = static_cast<double>(counts.nodes) / rays;
    state.counters["grids/ray"] = static_cast<double>(counts.grids) / rays;
    state.counters["blocks/ray"] = static_cast<double>(counts.blocks) / rays;
}

template <class Tracer>
void add(const char* tracer) {
    for (const NamedKind& kind : kKinds)
        for (const bool moves : {false, true})
            if (kFindsClosest<Tracer> || asks_any(kind.kind))
                benchmark::RegisterBenchmark(named(kind, moves, tracer).c_str(), trace<Tracer>, kind.kind,
                                             moves)
                    ->Unit(benchmark::kMillisecond);
}

[[maybe_unused]] const bool kAdded = [] {
    for (const NamedKind& kind : kKinds)
        for (const bool moves : {false, true})
            benchmark::RegisterBenchmark(named(kind, moves, "counts").c_str(), count, kind.kind, moves)
                ->Iterations(1)
                ->Unit(benchmark::kMillisecond);
    add<Scalar>("scalar");
    add<Wide>("wide");
    add<WideTogether>("wide_together");
#ifdef TRAPEZE_HAVE_EMBREE
    add<Embree<false, false>>("embree_grids");
    add<Embree<true, false>>("embree_quads");
    add<Embree<false, true>>("embree_grids_stream");
    add<Embree<true, true>>("embree_quads_stream");
#endif
    return true;
}();

}  // namespace
}  // namespace trapeze

int main(int argc, char** argv) {
    return trapeze::run_benchmarks(argc, argv);
}
