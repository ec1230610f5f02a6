#include "shade/clouds/surfel_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace trapeze {
namespace {

constexpr float kUnitDisc = std::numbers::pi_v<float>;
constexpr uint32_t kLeafSurfels = 8;
constexpr int kMostDepthOfTree = 40;     ///< leaves there may hold any number: discs in one place
constexpr size_t kMostWaiting = 8 * 41;  ///< nodes: seven of each level and eight of the last
constexpr float kLeastPart = 0.3f;       ///< of the threshold, that clusters at the horizon are compared by
/// Of a disc's radius, where no bias is given. Measured against rays (docs/results.md): with less curved
/// surfaces hide themselves, with more contacts are open.
constexpr float kSelfPart = 0.35f;

/// Whether distances to it are numbers.
bool is_within_numbers(const V3f& v) {
    return std::isfinite(v.length2());
}

bool counts(const Surfels& surfels, uint32_t i) {
    return is_within_numbers(surfels.positions[i]) && is_within_numbers(surfels.normals[i]) &&
           std::isfinite(surfels.areas[i]) && surfels.areas[i] > 0;
}

float usable(float max_solid_angle) {
    return std::min(std::max(max_solid_angle, SurfelTree::kLeastSolidAngle), SurfelTree::kMostSolidAngle);
}

V3f finite(const V3f& color) {
    return is_within_numbers(color) ? color : V3f(0);
}

/// The discs' area: what is seen from all directions in the mean is a quarter of it.
float whole_area(const Harmonics& area) {
    return 4 * area[0] * harmonics_at(V3f(0, 0, 1))[0];
}

/// Areas of the fronts that are seen from a direction, and from the opposite one. Nine harmonics know the
/// difference exactly: it is the discs' vector area along the direction. The sum of discs that all look one
/// way they have too large or too small by a sixteenth; what they lack is added as far as the discs do so.
BothWays areas_seen(const Harmonics& area, float lacking, float of_vector, const Harmonics& at) {
    BothWays seen = both_ways(area, at);
    const float all = whole_area(area), x = std::abs(seen.there - seen.back) * of_vector;
    const float lacks = lacking * (x / 2 - 0.25f - 0.15625f * (3 * x * x - 1));
    return {std::clamp(seen.there + lacks, 0.0f, all), std::clamp(seen.back + lacks, 0.0f, all)};
}

/// The length of the discs' vector area.
float vector_area(const Harmonics& area) {
    constexpr float kOfVector = 1.02332671f;  // sqrt(pi / 3), a vector's in band 1
    return V3f(area[3], area[1], area[2]).length() / kOfVector;
}

/// The mean colour of a side, from power and area as seen; where next to nothing is seen, of all sides.
float mean_color(float power, float area, float all_power, float all_area) {
    constexpr float kLeastSeen = 0.1f;
    if (area < kLeastSeen * all_area) return std::max(0.0f, all_power / all_area);
    return std::max(0.0f, power / area);
}

void add(Harmonics& to, const Harmonics& more) {
    for (size_t i = 0; i < to.size(); ++i) to[i] += more[i];
}

/// Cells are halved along those axes along which they are not much shorter than along others: they stay about
/// as long as wide.
unsigned octant_of(const V3f& p, const Box3f& box) {
    const V3f size = box.size(), middle = box.min + size * 0.5f;
    const float most = std::max({size.x, size.y, size.z});
    unsigned octant = 0;
    for (int k = 0; k < 3; ++k)
        if (size[k] > most / 2 && p[k] >= middle[k]) octant |= 1u << k;
    return octant;
}

}  // namespace

SurfelTree::SurfelTree(const Surfels& surfels) {
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < surfels.size(); ++i)
        if (counts(surfels, i)) order.push_back(i);
    if (order.empty()) return;
    nodes_.resize(1);
    nodes_[0].end = static_cast<uint32_t>(order.size());
    build(0, order, surfels, 0);
    nodes_.shrink_to_fit();
    surfels_.positions.reserve(order.size()), surfels_.normals.reserve(order.size());
    surfels_.areas.reserve(order.size()), surfels_.quads.reserve(surfels.quads.empty() ? 0 : order.size());
    surfels_.ids.reserve(surfels.ids.empty() ? 0 : order.size());
    surfels_.opacities.reserve(surfels.opacities.empty() ? 0 : order.size());
    for (const uint32_t i : order) {
        surfels_.positions.push_back(surfels.positions[i]);
        surfels_.normals.push_back(surfels.normals[i]);
        surfels_.areas.push_back(surfels.areas[i]);
        if (!surfels.opacities.empty()) surfels_.opacities.push_back(surfels.opacities[i]);
        if (!surfels.ids.empty()) surfels_.ids.push_back(surfels.ids[i]);
        if (!surfels.quads.empty()) surfels_.quads.push_back(surfels.quads[i]);
    }
    if (!surfels.radiosities.empty()) {
        surfels_.radiosities.reserve(order.size());
        for (const uint32_t i : order) surfels_.radiosities.push_back(finite(surfels.radiosities[i]));
    }
    sum_up();
}

size_t SurfelTree::bytes() const {
    return surfels_.bytes() + back_radiosities_.capacity() * sizeof(V3f) + nodes_.capacity() * sizeof(Node) +
           (powers_.capacity() + back_powers_.capacity()) * sizeof(Power);
}

float SurfelTree::disc_radius(uint32_t surfel) const {
    return std::sqrt(disc_area(surfel) / kUnitDisc);
}

SurfelQuad SurfelTree::quad_from(const V3f& place, uint32_t surfel) const {
    SurfelQuad quad = surfels_.quads[surfel];
    for (V3f& corner : quad) corner -= place;
    return quad;
}

/// Sorts a node's part of `order` by octants, and makes its children.
void SurfelTree::build(uint32_t number, std::vector<uint32_t>& order, const Surfels& from, int depth) {
    const uint32_t first = nodes_[number].first, end = nodes_[number].end;
    if (end - first <= kLeafSurfels || depth == kMostDepthOfTree) return;
    Box3f box;
    for (uint32_t i = first; i < end; ++i) box.extendBy(from.positions[order[i]]);
    if (!is_within_numbers(box.size()) || box.min == box.max) return;
    std::array<std::vector<uint32_t>, 8> octants;
    for (uint32_t i = first; i < end; ++i)
        octants[octant_of(from.positions[order[i]], box)].push_back(order[i]);
    const auto child = static_cast<uint32_t>(nodes_.size());
    uint32_t next = first;
    for (const std::vector<uint32_t>& octant : octants) {
        if (octant.empty()) continue;
        Node node;
        node.first = next;
        for (const uint32_t i : octant) order[next++] = i;
        node.end = next;
        nodes_.push_back(node);
    }
    octants = {};
    const auto children = static_cast<uint32_t>(nodes_.size()) - child;
    nodes_[number].child = child, nodes_[number].children = children;
    for (uint32_t i = 0; i < children; ++i) build(child + i, order, from, depth + 1);
}

/// Children stand behind their parents: from the end, they are known when they are asked for.
void SurfelTree::sum_up() {
    for (size_t n = nodes_.size(); n-- > 0;) sum_node(nodes_[n]);
    if (has_radiosities()) powers_ = powers_of(surfels_.radiosities);
}

std::vector<SurfelTree::Power> SurfelTree::powers_of(const std::vector<V3f>& radiosities) const {
    std::vector<Power> powers(nodes_.size(), Power{});
    for (size_t n = nodes_.size(); n-- > 0;) {
        const Node& node = nodes_[n];
        for (size_t k = 0; k < 3; ++k) {
            for (uint32_t c = node.child; c < node.child + node.children; ++c)
                add(powers[n][k], powers[c][k]);
            for (uint32_t i = node.first; i < node.end && node.children == 0; ++i)
                add_cosine(powers[n][k], surfels_.normals[i],
                           surfels_.areas[i] * radiosities[i][static_cast<int>(k)]);
        }
    }
    return powers;
}

void SurfelTree::set_radiosities(std::vector<V3f> fronts, std::vector<V3f> backs) {
    for (std::vector<V3f>* const colors : {&fronts, &backs})
        for (V3f& color : *colors) color = finite(color);
    powers_ = powers_of(fronts), back_powers_ = powers_of(backs);
    surfels_.radiosities = std::move(fronts), back_radiosities_ = std::move(backs);
}

size_t SurfelTree::bytes_of_radiosities() const {
    return 2 * (surfels_.size() * sizeof(V3f) + nodes_.size() * sizeof(Power));
}

void SurfelTree::sum_node(Node& node) {
    V3d sum(0);
    double area = 0, whole = 0;
    for (uint32_t i = node.first; i < node.end; ++i) {
        const auto own = static_cast<double>(surfels_.areas[i]);
        sum += V3d(surfels_.positions[i]) * own;
        area += own, whole += static_cast<double>(disc_area(i));
    }
    node.middle = V3f(sum / area);
    if (is_seen_through()) node.opacity = static_cast<float>(area / whole);
    for (uint32_t i = node.first; i < node.end; ++i)
        node.radius = std::max(node.radius, (surfels_.positions[i] - node.middle).length() + disc_radius(i));
    for (uint32_t c = node.child; c < node.child + node.children; ++c) add(node.area, nodes_[c].area);
    for (uint32_t i = node.first; i < node.end && node.children == 0; ++i)
        add_cosine(node.area, surfels_.normals[i], surfels_.areas[i]);
    const float all = whole_area(node.area), length = vector_area(node.area);
    if (!(all > 0 && length > 0)) return;
    const float aligned = std::min(length / all, 1.0f), cubed = aligned * aligned * aligned;
    node.of_vector = 1 / length, node.lacking = all * cubed * cubed;
}

void SurfelTree::cut(const SurfelPlace& place, std::vector<SurfelPiece>& pieces) const {
    pieces.clear();
    if (nodes_.empty()) return;
    const float most = usable(place.max_solid_angle);
    uint32_t waiting[kMostWaiting];
    size_t count = 0;
    waiting[count++] = 0;
    while (count > 0) {
        const uint32_t number = waiting[--count];
        const Node& node = nodes_[number];
        const V3f way = node.middle - place.position;
        if (way.dot(place.normal) + node.radius <= 0) continue;
        const float distance2 = way.length2();
        const float reach = place.max_distance + node.radius;
        if (distance2 > reach * reach) continue;
        // Things near the horizon cover fewer of the raster's pixels, by the cosine: they may be larger.
        const float distance = std::sqrt(distance2), up = way.dot(place.normal) + node.radius;
        const float part = std::clamp(up, kLeastPart * distance, distance);
        if (kUnitDisc * node.radius * node.radius * part < most * distance2 * distance) {
            add_node(node, number, place, pieces);
            continue;
        }
        for (uint32_t i = node.first; i < node.end && node.children == 0; ++i) add_disc(i, place, pieces);
        for (uint32_t c = node.children; c-- > 0;) waiting[count++] = node.child + c;
    }
}

/// A cluster as a whole, as its middle is seen.
void SurfelTree::add_node(const Node& node, uint32_t number, const SurfelPlace& place,
                          std::vector<SurfelPiece>& pieces) const {
    if (node.end - node.first == 1) return add_disc(node.first, place, pieces);
    SurfelPiece piece;
    piece.way = node.middle - place.position;
    piece.distance = piece.way.length();
    if (!std::isfinite(piece.distance) || piece.distance > place.max_distance) return;
    if (piece.way.dot(place.normal) <= 0) return;
    const V3f from = piece.way / -piece.distance;
    const BothWays seen = areas_seen(node.area, node.lacking, node.of_vector, harmonics_at(from));
    piece.front = seen.there, piece.back = seen.back;
    piece.number = number, piece.is_cluster = true, piece.opacity = node.opacity;
    pieces.push_back(piece);
}

/// Whether a disc is the surface that the place is on, which it would cover. A wall that stands on the
/// surface may be as near, but stands across it.
bool SurfelTree::is_own_surface(const SurfelPiece& piece, uint32_t surfel, const SurfelPlace& place) const {
    const V3f& normal = surfels_.normals[surfel];
    const float beside = normal == V3f(0) ? piece.distance : std::abs(piece.way.dot(normal));
    if (place.bias >= 0) return beside < place.bias;
    const float along = normal == V3f(0) ? 1 : std::abs(normal.dot(place.normal));
    return beside < kSelfPart * disc_radius(surfel) * along;
}

void SurfelTree::add_disc(uint32_t surfel, const SurfelPlace& place, std::vector<SurfelPiece>& pieces) const {
    SurfelPiece piece;
    piece.way = surfels_.positions[surfel] - place.position;
    const V3f& normal = surfels_.normals[surfel];
    const float area = surfels_.areas[surfel], distance2 = piece.way.length2();
    const float most = usable(place.max_solid_angle);
    piece.distance = std::sqrt(distance2);
    if (!(distance2 > 0) || !std::isfinite(distance2) || piece.distance > place.max_distance) return;
    piece.is_large = disc_area(surfel) > most * distance2;
    const float toward = -piece.way.dot(normal);  // the distance between the place and the disc's plane
    const float seen = normal == V3f(0) ? area : area * std::abs(toward) / piece.distance;
    if (normal == V3f(0))
        piece.front = piece.back = area;
    else
        (toward > 0 ? piece.front : piece.back) = seen;
    if (piece.is_large && is_own_surface(piece, surfel, place)) return;
    if (!piece.is_large && piece.way.dot(place.normal) <= 0) return;
    piece.number = surfel, piece.opacity = opacity(surfel);
    pieces.push_back(piece);
}

V3f SurfelTree::radiosity(const SurfelPiece& piece) const {
    if (!has_radiosities()) return V3f(0);
    const bool two_sided = !back_radiosities_.empty();
    if (!piece.is_cluster)
        return (two_sided && piece.back > piece.front ? back_radiosities_
                                                      : surfels_.radiosities)[piece.number];
    const Harmonics at = harmonics_at(piece.way / -piece.distance);
    const Harmonics& of_node = nodes_[piece.number].area;
    const BothWays area = both_ways(of_node, at);
    const float all = whole_area(of_node), sides = piece.front + piece.back;
    V3f color(0);
    for (int k = 0; k < 3 && sides > 0; ++k) {
        const auto channel = static_cast<size_t>(k);
        const Harmonics& fronts = powers_[piece.number][channel];
        const Harmonics& backs = (two_sided ? back_powers_ : powers_)[piece.number][channel];
        color[k] =
            (mean_color(both_ways(fronts, at).there, area.there, whole_area(fronts), all) * piece.front +
             mean_color(both_ways(backs, at).back, area.back, whole_area(backs), all) * piece.back) /
            sides;
    }
    return color;
}

}  // namespace trapeze
