/// The shading language's trace(), transmission(), visibility(), occlusion() and indirectdiffuse(), with
/// optional arguments as PRMan's, its gather blocks, and its shadow() of a light that is traced.
#pragma once

#include <unordered_map>
#include <vector>

#include "core/scene/scene.h"
#include "shade/rays/ray_arguments.h"
#include "shade/rays/ray_asker.h"

namespace trapeze {

class LaneMotion;
struct RayAim;

/// Carries out the calls of one grid's shaders, in one thread.
class RayCalls : public vm::Rays {
  public:
    /// `attributes`: of the surface that is shaded.
    RayCalls(const RayService& service, const Attributes& attributes) : asker_(service, attributes) {}
    /// A shader that is run again for the same grids takes the same random numbers.
    void begin_anew() { calls_.clear(); }

    Task<> trace(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands) override;
    std::unique_ptr<vm::GatherTurns> gather(vm::Run& run, const vm::Step& step,
                                            std::span<const vm::Operand> operands) override;
    vm::RayFacts facts() const override;
    /// RayAsker::ask_within_medium(), of the calls that follow.
    void ask_within_medium(bool within, bool for_opacity) { asker_.ask_within_medium(within, for_opacity); }

  private:
    struct Call;
    /// The rays of some lanes, one lane's after another's.
    struct LaneRays {
        std::vector<WalkedRay> rays;
        std::vector<size_t> ends;  ///< behind each lane's last
        bool followed = false;     ///< else they are too deep to see anything
        std::vector<V3f> sky;      ///< what is behind each, if anything is asked
        /// Rays, by number, that their own surface is in the way of, and what it leaves of their light.
        std::vector<std::pair<size_t, V3f>> turned_away;
        /// The ends of rays that come to the surface which asks, from there; and the numbers of those rays.
        std::vector<WalkedRay> arrivals;
        std::vector<size_t> arriving;
        RayStarts starts, arrival_starts;  ///< of rays and of arrivals
    };

    std::vector<RayLane> lanes_of(vm::Run& run, const vm::Step& step, bool uniform);
    SurfaceBend bend_of(const ShadingGrid* grid);
    Task<LaneRays> rays_of(const Call& call, std::span<const RayLane> lanes);
    static void tell(const Call& call, const vm::Operand& out, std::span<const RayLane> lanes,
                     const LaneRays& sent, const V3f& nothing);
    void add_rays(const Call& call, const RayLane& lane, LaneRays& sent) const;
    void add_arrival(const Call& call, const RayLane& lane, const RayAim& aim, const LaneMotion& motion,
                     LaneRays& sent) const;
    void begin_on_ground(const Call& call, const RayLane& lane, const RayAim& aim, const LaneMotion& motion,
                         const V3f& beside, LaneRays& sent) const;
    static void end_at_arrivals(LaneRays& sent);
    Task<> dim_by_own_surface(const Call& call, LaneRays& sent) const;
    RayFootprint footprint_of(const Call& call, const RayLane& asking, const RayAim& aim,
                              const LaneMotion& motion) const;
    Task<bool> follow(const Call& call, std::span<WalkedRay> rays) const;
    void look_at_sky(const Call& call, const vm::Operand& out, std::span<const RayLane> lanes) const;

    RayAsker asker_;
    RayGrounds grounds_;
    /// How often a call has been made for each lane: calls in loops take other random numbers each time.
    std::unordered_map<const vm::Step*, std::vector<uint32_t>> calls_;
    std::unordered_map<const ShadingGrid*, SurfaceBend> bends_;
};

}  // namespace trapeze
