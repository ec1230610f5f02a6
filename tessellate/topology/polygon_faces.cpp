#include "tessellate/topology/polygon_faces.h"

#include <cmath>

#include "tessellate/topology/triangulate.h"

namespace trapeze {
namespace {

/// How far a quad's corners may lie from their plane, as a fraction of its size, and how straight its angles
/// may be (the sine), to be one bilinear face.
constexpr double kFlatness = 1e-4, kLeastSine = 1e-2;

/// By which part of a polygon one way to cut it has to cover less beside it than another to be better.
constexpr double kLeastExcess = 1e-4;

/// Goes through the polygons one by one.
class FaceMaker {
  public:
    FaceMaker(const PolygonMesh& mesh, std::span<const std::span<const float>> keys)
        : mesh_(mesh), keys_(keys) {}

    PolygonFaces run();
    PolygonFaces whole();

  private:
    void polygon(int number, std::span<const int> loop_sizes);
    V3d position(int corner, size_t key = 0) const {
        const float* p = keys_[key].data() + 3 * static_cast<size_t>(mesh_.vertices[corner]);
        return {p[0], p[1], p[2]};
    }
    /// Lists the corners of the polygon at hand, by loop, and moves on to the next polygon.
    void gather(std::span<const int> loop_sizes);
    /// Of a loop of so many corners from one on, by Newell's method: as long as twice its area.
    V3d area_normal(int first, int count, size_t key) const;
    using Triangles = std::vector<std::array<int, 3>>;
    /// Of the polygon at hand as it is at a key, in numbers of corners_.
    Triangles triangles_at(size_t key) const;
    /// By how much triangles cover more than the polygon, over all keys; twice the area.
    double excess_of(const Triangles& triangles) const;
    Triangles best_triangles() const;
    /// Whether the four corners at hand are one bilinear face.
    bool is_flat_and_convex(const V3d& normal) const;
    /// Adds a face, unless it names a vertex twice: it would have a side without length.
    void add(int polygon, std::span<const int> corners);

    const PolygonMesh& mesh_;
    std::span<const std::span<const float>> keys_;
    PolygonFaces faces_;
    int first_corner_ = 0;  ///< of the polygon at hand
    // The polygon at hand, without corners that repeat the one before:
    std::vector<int> corners_, loops_;
};

PolygonFaces FaceMaker::run() {
    size_t loop = 0;
    for (size_t i = 0; i < mesh_.loops_per_polygon.size(); ++i) {
        polygon(static_cast<int>(i),
                std::span(mesh_.vertices_per_loop).subspan(loop, mesh_.loops_per_polygon[i]));
        loop += mesh_.loops_per_polygon[i];
    }
    return std::move(faces_);
}

/// Faces stay as they are, whatever their number of corners.
PolygonFaces FaceMaker::whole() {
    for (size_t i = 0; i < mesh_.vertices_per_loop.size(); ++i) {
        gather(std::span(mesh_.vertices_per_loop).subspan(i, 1));
        if (loops_[0] >= 3) add(static_cast<int>(i), corners_);
    }
    return std::move(faces_);
}

/// Corners that name the vertex of the one before would make sides without length; they are dropped, also
/// where the loop closes.
void FaceMaker::gather(std::span<const int> loop_sizes) {
    corners_.clear(), loops_.clear();
    for (int size : loop_sizes) {
        const size_t begin = corners_.size();
        for (int i = 0; i < size; ++i) {
            const int vertex = mesh_.vertices[first_corner_ + i];
            if (corners_.size() == begin || mesh_.vertices[corners_.back()] != vertex)
                corners_.push_back(first_corner_ + i);
        }
        while (corners_.size() > begin + 1 &&
               mesh_.vertices[corners_.back()] == mesh_.vertices[corners_[begin]])
            corners_.pop_back();
        loops_.push_back(static_cast<int>(corners_.size() - begin));
        first_corner_ += size;
    }
}

V3d FaceMaker::area_normal(int first, int count, size_t key) const {
    const V3d origin = position(corners_[first], key);
    V3d sum(0, 0, 0);
    for (int i = first + 1; i + 1 < first + count; ++i)
        sum += (position(corners_[i], key) - origin).cross(position(corners_[i + 1], key) - origin);
    return sum;
}

/// Such a quad is one face; any other is cut into triangles, which are flat whatever their corners.
bool FaceMaker::is_flat_and_convex(const V3d& normal) const {
    const double length = normal.length();
    if (!(length > 0)) return false;
    V3d p[4];
    for (int i = 0; i < 4; ++i) p[i] = position(corners_[i]);
    const double size = std::max((p[2] - p[0]).length(), (p[3] - p[1]).length());
    for (int i = 0; i < 4; ++i) {
        const V3d in = p[i] - p[(i + 3) & 3], out = p[(i + 1) & 3] - p[i];
        if (!(in.cross(out).dot(normal) > kLeastSine * in.length() * out.length() * length)) return false;
        if (!(std::abs(in.dot(normal)) <= kFlatness * size * length)) return false;
    }
    return true;
}

/// A face that has a vertex twice is left out: it has no area, or would have an edge with itself.
void FaceMaker::add(int polygon, std::span<const int> corners) {
    for (size_t i = 0; i < corners.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            if (mesh_.vertices[corners[i]] == mesh_.vertices[corners[j]]) return;
    faces_.sizes.push_back(static_cast<int>(corners.size()));
    faces_.polygons.push_back(polygon);
    for (int corner : corners) {
        faces_.corners.push_back(corner);
        faces_.vertices.push_back(mesh_.vertices[corner]);
    }
}

/// In a plane along two axes, which projects without rounding.
FaceMaker::Triangles FaceMaker::triangles_at(size_t key) const {
    const V3d normal = area_normal(0, loops_[0], key);
    // Along the axis nearest to the normal: coordinates stay as they are, exact.
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
    std::vector<V2d> points;
    points.reserve(corners_.size());
    for (int corner : corners_) {
        const V3d p = position(corner, key);
        points.emplace_back(p[(axis + 1) % 3], p[(axis + 2) % 3]);
    }
    return triangulate(points, loops_);
}

double FaceMaker::excess_of(const Triangles& triangles) const {
    double sum = 0;
    for (size_t key = 0; key < keys_.size(); ++key) {
        for (const auto& [a, b, c] : triangles) {
            const V3d origin = position(corners_[a], key);
            sum += (position(corners_[b], key) - origin).cross(position(corners_[c], key) - origin).length();
        }
        int first = 0;
        for (int count : loops_) {
            if (count >= 3) sum += area_normal(first, count, key).length() * (first == 0 ? -1 : 1);
            first += count;
        }
    }
    return sum;
}

/// A polygon that moves may have no area where it begins, or have corners on a line: how it is to be cut is
/// then seen at another key. Where the first one's way is as good as others it stays.
FaceMaker::Triangles FaceMaker::best_triangles() const {
    Triangles best = triangles_at(0);
    if (keys_.size() == 1) return best;
    double least = excess_of(best), size = 0;
    for (size_t key = 0; key < keys_.size(); ++key) size += area_normal(0, loops_[0], key).length();
    for (size_t key = 1; key < keys_.size() && least > kLeastExcess * size; ++key) {
        Triangles other = triangles_at(key);
        const double excess = excess_of(other);
        if (excess < least - kLeastExcess * size) best = std::move(other), least = excess;
    }
    return best;
}

/// A flat convex quad stays whole, for it dices into the better grid; all others are triangulated.
void FaceMaker::polygon(int number, std::span<const int> loop_sizes) {
    gather(loop_sizes);
    if (loops_.empty() || loops_[0] < 3) return;
    if (loops_.size() == 1 && loops_[0] == 3) return add(number, corners_);
    if (loops_.size() == 1 && loops_[0] == 4 && is_flat_and_convex(area_normal(0, 4, 0)))
        return add(number, corners_);
    for (const std::array<int, 3>& t : best_triangles()) {
        const int corners[3] = {corners_[t[0]], corners_[t[1]], corners_[t[2]]};
        add(number, corners);
    }
}

}  // namespace

PolygonFaces make_polygon_faces(const PolygonMesh& mesh, std::span<const std::span<const float>> keys) {
    return FaceMaker(mesh, keys).run();
}

PolygonFaces make_whole_faces(const PolygonMesh& mesh) {
    return FaceMaker(mesh, {}).whole();
}

}  // namespace trapeze
