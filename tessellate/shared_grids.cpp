#include "tessellate/shared_grids.h"

#include <array>
#include <cstring>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "tessellate/topology/topology_surface.h"

namespace trapeze {
namespace {

/// Points of a face at a shape key, evaluated once; object space. Held by shared pointers, so that a thread
/// may copy from them after the shelf's lock is gone.
struct KnownPoints {
    int face, shape_key;
    std::vector<V2f> uv;
    std::vector<V3f> P, dPdu, dPdv;  ///< derivatives may be empty: not wanted

    size_t bytes() const {
        constexpr size_t kOfTheTable = 128;  // and of allocations, about
        return kOfTheTable + sizeof(*this) + uv.size() * sizeof(V2f) +
               (P.size() + dPdu.size() + dPdv.size()) * sizeof(V3f);
    }
    bool are(int other_face, std::span<const V2f> other_uv, int other_key, bool derivatives) const {
        return face == other_face && shape_key == other_key && derivatives == !dPdu.empty() &&
               uv.size() == other_uv.size() &&
               std::memcmp(uv.data(), other_uv.data(), uv.size() * sizeof(V2f)) == 0;
    }
};

/// A hash of a few of the points: grids of a face differ in these. are() compares all of them.
size_t hash_of(int face, std::span<const V2f> uv, int shape_key, bool derivatives) {
    const V2f &first = uv.front(), &middle = uv[uv.size() / 2], &last = uv.back();
    uint64_t hash = static_cast<uint64_t>(face) << 32 | static_cast<uint64_t>(uv.size() << 8) |
                    static_cast<uint64_t>(shape_key << 1) | derivatives;
    for (const float x : {first.x, first.y, middle.x, middle.y, last.x, last.y}) {
        uint32_t bits;
        std::memcpy(&bits, &x, sizeof(bits));
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    }
    return hash;
}

/// The surface that remembers. Shelves, each with its own lock, so that threads seldom wait for each other.
class SharedGrids final : public TopologySurface<SharedGrids> {
  public:
    SharedGrids(std::shared_ptr<const Surface> surface, SharedGridBudget& budget)
        : surface_(std::move(surface)), budget_(budget) {}

    const Surface& topology() const { return *surface_; }
    bool is_hole(int face) const override { return surface_->is_hole(face); }
    bool stands_alone(int face) const override { return surface_->stands_alone(face); }
    std::unique_ptr<SurfaceScratch> make_scratch() const override { return surface_->make_scratch(); }
    bool has_motion_keys() const override { return surface_->has_motion_keys(); }
    bool evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch* scratch,
                            ShadingGrid& grid) const override {
        return surface_->evaluate_variables(face, uv, scratch, grid);
    }
    Box3f bound(int face, V2f lo, V2f hi, int shape_key) const override {
        return surface_->bound(face, lo, hi, shape_key);
    }
    V2f faces_per_unit(int face) const override { return surface_->faces_per_unit(face); }
    bool is_faceted() const override { return surface_->is_faceted(); }
    bool has_lattices() const override { return surface_->has_lattices(); }
    void lattices(int first, int count, int shape_key, bool beside, FaceLattices& lattices) const override {
        surface_->lattices(first, count, shape_key, beside, lattices);
    }

    /// Two threads may evaluate the same points at once and both put them away: that wastes memory and
    /// changes nothing.
    void evaluate(int face, std::span<const V2f> uv, int shape_key, SurfaceScratch* scratch, std::span<V3f> P,
                  std::span<V3f> dPdu, std::span<V3f> dPdv) const override {
        const bool derivatives = !dPdu.empty();
        if (uv.empty() || derivatives != !dPdv.empty()) {
            surface_->evaluate(face, uv, shape_key, scratch, P, dPdu, dPdv);
            return;
        }
        const size_t hash = hash_of(face, uv, shape_key, derivatives);
        Shelf& shelf = shelves_[hash % kShelves];
        if (const auto known = find(shelf, hash, face, uv, shape_key, derivatives)) {
            std::ranges::copy(known->P, P.begin());
            std::ranges::copy(known->dPdu, dPdu.begin());
            std::ranges::copy(known->dPdv, dPdv.begin());
            return;
        }
        surface_->evaluate(face, uv, shape_key, scratch, P, dPdu, dPdv);
        if (budget_.bytes_left.load(std::memory_order_relaxed) == 0) return;
        auto points = std::make_shared<KnownPoints>(KnownPoints{face,
                                                                shape_key,
                                                                {uv.begin(), uv.end()},
                                                                {P.begin(), P.end()},
                                                                {dPdu.begin(), dPdu.end()},
                                                                {dPdv.begin(), dPdv.end()}});
        if (!take_bytes(points->bytes())) return;
        const std::lock_guard lock(shelf.mutex);
        shelf.known.emplace(hash, std::move(points));
    }

  private:
    static constexpr size_t kShelves = 64;

    struct Shelf {
        std::mutex mutex;
        std::unordered_multimap<size_t, std::shared_ptr<const KnownPoints>> known;
    };

    static std::shared_ptr<const KnownPoints> find(Shelf& shelf, size_t hash, int face,
                                                   std::span<const V2f> uv, int shape_key, bool derivatives) {
        const std::lock_guard lock(shelf.mutex);
        const auto [begin, end] = shelf.known.equal_range(hash);
        for (auto at = begin; at != end; ++at)
            if (at->second->are(face, uv, shape_key, derivatives)) return at->second;
        return nullptr;
    }

    /// Takes bytes from the budget. False where they are more than are left; the budget is empty from then
    /// on, so that nobody tries again.
    bool take_bytes(size_t bytes) const {
        size_t left = budget_.bytes_left.load(std::memory_order_relaxed);
        while (left >= bytes)
            if (budget_.bytes_left.compare_exchange_weak(left, left - bytes)) return true;
        budget_.bytes_left = 0;
        return false;
    }

    const std::shared_ptr<const Surface> surface_;
    SharedGridBudget& budget_;
    mutable std::array<Shelf, kShelves> shelves_;
};

}  // namespace

std::unique_ptr<Surface> share_grids(std::shared_ptr<const Surface> surface, SharedGridBudget& budget) {
    return std::make_unique<SharedGrids>(std::move(surface), budget);
}

/// Other kinds evaluate a point for about what a look into the shelves costs.
bool pays_to_share(const Topology& topology) {
    return std::holds_alternative<SubdivisionMesh>(topology) || std::holds_alternative<NuPatch>(topology);
}

}  // namespace trapeze
