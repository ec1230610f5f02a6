/// Finds the points of a cloud that reach a place.
#pragma once

#include <cstdint>
#include <vector>

#include "shade/clouds/point_cloud.h"

namespace trapeze {

/// Where a cloud is asked.
struct CloudPlace {
    V3f position;
    V3f normal{0, 0, 0};     ///< of unit length; zero: points of all sides count
    float radius = 0;        ///< how far points reach, all alike; 0: each as far as its own radius says
    float radius_scale = 1;  ///< to be multiplied with either
};

/// A point and its share of what is interpolated.
struct CloudShare {
    uint32_t point = 0;
    double weight = 0;
};

/// A binary tree of boxes over the points. Immutable; asked by all threads.
class CloudTree {
  public:
    /// The cloud outlives this. Points that are not finite are not in the tree.
    explicit CloudTree(const PointCloud& cloud);

    /// The points that reach a place, with weights whose sum is 1, in an order that depends on the cloud
    /// alone; none where there are none.
    ///
    /// A point reaches kReach of its radii r far: points in the middle of a grid of squares of side h, for
    /// which pi r^2 = h^2, 2.26 h. Its weight is (1 - (d / reach)^2)^4 of the distance d, times its area,
    /// times the cosine between the normals; points whose normal opposes the place's do not count.
    void find(const CloudPlace& place, std::vector<CloudShare>& shares) const;

    static constexpr float kReach = 4;
    /// More points than this are not added up: a bound on what a wide lookup costs.
    static constexpr size_t kMostShares = 4096;

    size_t bytes() const;

  private:
    struct Node {
        Box3f box;           ///< of the points' places
        float radius = 0;    ///< the largest of a point
        uint32_t first = 0;  ///< of points in order_; of an inner node: the second child's number
        uint32_t count = 0;  ///< of points; 0: an inner node, whose first child is the next node
    };
    uint32_t build(uint32_t first, uint32_t end);
    float radius_of(uint32_t point) const;
    void add(uint32_t point, const CloudPlace& place, std::vector<CloudShare>& shares) const;

    const PointCloud& cloud_;
    std::vector<uint32_t> order_;
    std::vector<Node> nodes_;
    float usual_radius_ = 0;  ///< of points without one
};

}  // namespace trapeze
