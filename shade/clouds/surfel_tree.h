/// Finds, for a point, the few discs and clusters of discs that stand for all discs of a cloud
/// [Christensen08].
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/scene/surfels.h"
#include "shade/clouds/spherical_harmonics.h"

namespace trapeze {

/// Where a cloud is looked at from, and how closely.
struct SurfelPlace {
    V3f position, normal;          ///< of unit length: what lies below is not seen
    float max_solid_angle = 0.1f;  ///< of a cluster that is taken as one, steradians
    float max_distance = std::numeric_limits<float>::infinity();
    /// Large discs whose plane passes nearer do not count: they are the surface itself. Below 0: a third of
    /// each disc's radius where it lies as the surface does, and the less the more it stands across.
    float bias = -1;
};

/// A disc or a cluster, as seen from a place.
struct SurfelPiece {
    V3f way;                    ///< from the place to the middle
    float distance = 0;         ///< the way's length
    float front = 0, back = 0;  ///< areas of either side, projected along the way, as they hide
    float opacity = 1;          ///< what they hide of what is behind them
    uint32_t number = 0;        ///< of a surfel of the tree, or of a node
    bool is_cluster = false;
    bool is_large = false;  ///< a disc that takes more than the solid angle: its outline matters
};

/// An octree over discs. Asked by all threads; colours may come later.
class SurfelTree {
  public:
    /// Discs that are not finite, or have no area, are left out.
    explicit SurfelTree(const Surfels& surfels);

    /// The pieces that stand for all discs above the place's horizon, each disc by one of them, in an order
    /// that depends on the tree alone.
    void cut(const SurfelPlace& place, std::vector<SurfelPiece>& pieces) const;

    bool empty() const { return surfels_.size() == 0; }
    /// Whether light shines through some of the discs.
    bool is_seen_through() const { return !surfels_.opacities.empty(); }
    bool has_radiosities() const { return !surfels_.radiosities.empty(); }
    /// What the sides of the discs send, in the tree's order. Others may call cut() meanwhile.
    void set_radiosities(std::vector<V3f> fronts, std::vector<V3f> backs);
    /// What set_radiosities() takes, besides what it is given.
    size_t bytes_of_radiosities() const;
    /// The discs, in the tree's order.
    const Surfels& surfels() const { return surfels_; }
    float opacity(uint32_t surfel) const { return is_seen_through() ? surfels_.opacities[surfel] : 1; }
    /// What it has, and not what it hides.
    float disc_area(uint32_t surfel) const { return surfels_.areas[surfel] / opacity(surfel); }
    float disc_radius(uint32_t surfel) const;
    /// The ways from a place to the corners of what a disc stands for.
    SurfelQuad quad_from(const V3f& place, uint32_t surfel) const;
    /// The mean colour of what a piece shows.
    V3f radiosity(const SurfelPiece& piece) const;
    size_t bytes() const;

    /// Between these thresholds of solid angles work has a bound and clusters look small.
    static constexpr float kLeastSolidAngle = 1e-4f, kMostSolidAngle = 1;

  private:
    struct Node {
        V3f middle{0, 0, 0};  ///< the discs' mean place, weighted by their areas
        float radius = 0;     ///< of a ball around it that holds the discs
        float lacking = 0;    ///< how much of what harmonics lack is to be added (areas_seen())
        float opacity = 1;    ///< the discs' mean one
        float of_vector = 0;  ///< one over the length of the discs' vector area
        Harmonics area{};     ///< of the fronts, as seen from a direction
        uint32_t first = 0;   ///< of its surfels
        uint32_t end = 0;
        uint32_t child = 0;     ///< the first of its children, which stand side by side
        uint32_t children = 0;  ///< 0: a leaf
    };
    using Power = std::array<Harmonics, 3>;

    void build(uint32_t number, std::vector<uint32_t>& order, const Surfels& from, int depth);
    void sum_up();
    void sum_node(Node& node);
    std::vector<Power> powers_of(const std::vector<V3f>& radiosities) const;
    void add_node(const Node& node, uint32_t number, const SurfelPlace& place,
                  std::vector<SurfelPiece>& pieces) const;
    void add_disc(uint32_t surfel, const SurfelPlace& place, std::vector<SurfelPiece>& pieces) const;
    bool is_own_surface(const SurfelPiece& piece, uint32_t surfel, const SurfelPlace& place) const;

    Surfels surfels_;
    std::vector<Node> nodes_;
    std::vector<Power> powers_;          ///< of nodes: area times radiosity; empty without radiosities
    std::vector<V3f> back_radiosities_;  ///< of the discs' backs; empty: as the fronts
    std::vector<Power> back_powers_;     ///< by them, as if they were the fronts'
};

}  // namespace trapeze
