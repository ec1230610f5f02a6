#include "shade/clouds/cloud_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace trapeze {
namespace {

constexpr uint32_t kLeafPoints = 8;
constexpr size_t kMostDepth = 64;  ///< of a tree that is halved down to its leaves

double square(double x) {
    return x * x;
}

/// The square of the distance between a point and the nearest of a box.
double distance2(const Box3f& box, const V3f& p) {
    double sum = 0;
    for (int k = 0; k < 3; ++k)
        sum += square(
            std::max({0.0, static_cast<double>(box.min[k]) - p[k], static_cast<double>(p[k]) - box.max[k]}));
    return sum;
}

double dot(const V3f& a, const V3f& b) {
    return static_cast<double>(a.x) * b.x + static_cast<double>(a.y) * b.y + static_cast<double>(a.z) * b.z;
}

bool is_finite(const V3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

CloudTree::CloudTree(const PointCloud& cloud) : cloud_(cloud) {
    for (uint32_t i = 0; i < cloud.size(); ++i)
        if (is_finite(cloud.positions[i]) && std::isfinite(cloud.radii[i])) order_.push_back(i);
    if (order_.empty()) return;
    // As if they lay on a square as wide as the cloud.
    const V3f size = cloud.bounds().size();
    usual_radius_ = std::min(std::max({size.x, size.y, size.z}), std::numeric_limits<float>::max()) /
                    std::sqrt(static_cast<float>(order_.size()) * std::numbers::pi_v<float>);
    nodes_.reserve(2 * order_.size() / kLeafPoints + 1);
    build(0, static_cast<uint32_t>(order_.size()));
}

size_t CloudTree::bytes() const {
    return order_.capacity() * sizeof(uint32_t) + nodes_.capacity() * sizeof(Node);
}

float CloudTree::radius_of(uint32_t point) const {
    const float radius = cloud_.radii[point];
    return radius > 0 ? radius : usual_radius_;
}

/// Makes the node of order_[first .. end) and all below it; returns its number.
uint32_t CloudTree::build(uint32_t first, uint32_t end) {
    const auto number = static_cast<uint32_t>(nodes_.size());
    Node node;
    for (uint32_t i = first; i < end; ++i) {
        node.box.extendBy(cloud_.positions[order_[i]]);
        node.radius = std::max(node.radius, radius_of(order_[i]));
    }
    node.first = first, node.count = end - first;
    nodes_.push_back(node);
    if (node.count <= kLeafPoints) return number;
    const V3f size = node.box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t middle = first + node.count / 2;
    const auto at = [&](uint32_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(end), [&](uint32_t a, uint32_t b) {
        const float x = cloud_.positions[a][axis], y = cloud_.positions[b][axis];
        return x != y ? x < y : a < b;
    });
    build(first, middle);
    const uint32_t second = build(middle, end);
    nodes_[number].first = second, nodes_[number].count = 0;
    return number;
}

void CloudTree::add(uint32_t point, const CloudPlace& place, std::vector<CloudShare>& shares) const {
    const double own = radius_of(point);
    const double reach = static_cast<double>(place.radius_scale) *
                         (place.radius > 0 ? static_cast<double>(place.radius) : kReach * own);
    const V3f& p = cloud_.positions[point];
    const double d2 = square(static_cast<double>(p.x) - place.position.x) +
                      square(static_cast<double>(p.y) - place.position.y) +
                      square(static_cast<double>(p.z) - place.position.z);
    if (!(d2 < reach * reach)) return;
    const V3f& normal = cloud_.normals[point];
    const bool sided = place.normal != V3f(0) && normal != V3f(0);
    const double facing = sided ? dot(normal, place.normal) : 1;
    if (!(facing > 0)) return;
    const double area = own > 0 ? own * own : 1;
    shares.push_back({point, square(square(1 - d2 / (reach * reach))) * facing * area});
}

void CloudTree::find(const CloudPlace& place, std::vector<CloudShare>& shares) const {
    shares.clear();
    if (nodes_.empty() || !is_finite(place.position) || !(place.radius_scale > 0)) return;
    uint32_t waiting[kMostDepth];
    size_t count = 0;
    waiting[count++] = 0;
    while (count > 0 && shares.size() < kMostShares) {
        const uint32_t number = waiting[--count];
        const Node& node = nodes_[number];
        const double reach = static_cast<double>(place.radius_scale) *
                             (place.radius > 0 ? static_cast<double>(place.radius)
                                               : static_cast<double>(kReach) * node.radius);
        if (!(distance2(node.box, place.position) < reach * reach)) continue;
        for (uint32_t i = 0; i < node.count; ++i) add(order_[node.first + i], place, shares);
        if (node.count > 0) continue;
        waiting[count++] = node.first;
        waiting[count++] = number + 1;
    }
    double sum = 0;
    for (const CloudShare& share : shares) sum += share.weight;
    if (!(sum > 0)) return shares.clear();
    for (CloudShare& share : shares) share.weight /= sum;
}

}  // namespace trapeze
