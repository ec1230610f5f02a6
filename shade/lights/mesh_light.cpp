// Lights of any shape: triangles, tubes and balls, sampled by their area.
#include <algorithm>

#include "core/random.h"
#include "shade/lights/light_sampler.h"
#include "shade/lights/round_places.h"
#include "shade/lights/sphere_space.h"

namespace trapeze {
namespace {

/// Into how many parts of about the same area the list of pieces is cut. Of the square's two numbers one
/// chooses the part, the other one the piece in it. One number for both would go through the list in equal
/// steps, and find the same side of a thin tube again and again.
constexpr size_t kStrips = 16;

/// A place on a curve through all directions: normals that follow each other there are much alike. (Z-shaped,
/// over the octahedron unfolded to a square, 64 steps each way.)
uint32_t direction_of(const V3d& normal) {
    const double sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    double a = normal.x / sum, b = normal.y / sum;
    if (normal.z < 0) {
        const double folded = (1 - std::abs(b)) * std::copysign(1.0, a);
        b = (1 - std::abs(a)) * std::copysign(1.0, b), a = folded;
    }
    constexpr int kBits = 6;
    const auto step = [](double x) { return static_cast<uint32_t>(std::clamp((x + 1) / 2 * 64, 0.0, 63.0)); };
    const uint32_t column = step(a), row = step(b);
    uint32_t place = 0;
    for (int bit = 0; bit < kBits; ++bit)
        place |= (column >> bit & 1) << (2 * bit) | (row >> bit & 1) << (2 * bit + 1);
    return place;
}

/// A sphere's triangles, 32 along its longest side, have a sagitta of a fortieth of their sides. Of what is
/// round rays meet what lies in its middle.
constexpr float kRoughnessOfSide = 1.0f / 16;

float longest_side(const LightMesh::Triangle& t) {
    return std::max({(t.b - t.a).length(), (t.c - t.b).length(), (t.a - t.c).length()});
}

/// The list: triangles, and behind them tubes and balls. Parts of it are parts of the surface, for
/// micropolygons that follow each other are neighbours; within a part triangles follow their normals. So
/// places that are even over the square are so over the surface, and over the directions into which it
/// shines.
class MeshLight final : public LightSampler {
  public:
    MeshLight(const LightMesh& mesh, bool two_sided) {
        for (size_t i = 0; i < mesh.triangles.size(); ++i) {
            if (!take(area_of(mesh.triangles[i]))) continue;
            faces_.emplace_back(mesh.triangles[i], two_sided, places_.size());
            roughness_ = std::max(roughness_, kRoughnessOfSide * longest_side(mesh.triangles[i]));
            if (!mesh.places.empty()) places_.push_back(mesh.places[i]);
        }
        for (const LightMesh::Tube& tube : mesh.tubes)
            if (is_finite(wide(tube.from) + wide(tube.to)) && take(trapeze::area_of(tube))) {
                tubes_.push_back(tube);
                roughness_ = std::max({roughness_, tube.from_radius, tube.to_radius});
            }
        for (const LightMesh::Ball& ball : mesh.balls)
            if (is_finite(wide(ball.middle)) && take(trapeze::area_of(ball))) {
                balls_.push_back(ball);
                roughness_ = std::max(roughness_, ball.radius);
            }
        cut();
    }

    bool is_there() const { return !ends_.empty() && std::isfinite(ends_.back()); }
    float area() const override { return static_cast<float>(ends_.back()); }
    float roughness() const override { return roughness_; }

    LightSample sample(const V3f& P, const V3f&, const V2f& square) const override {
        const double x = static_cast<double>(square.x), y = static_cast<double>(square.y);
        const Found strip = find(x, 0, strips_.size(), [&](size_t i) { return end_of(strips_[i]); });
        const size_t first = strip.number > 0 ? strips_[strip.number - 1] : 0;
        const auto end_of_piece = [&](size_t i) { return ends_[i]; };
        const size_t end = strips_[strip.number], tubes = faces_.size(), balls = tubes + tubes_.size();
        if (first >= tubes && first < balls) {
            // One number goes along tubes, the other one around them.
            const Found piece = find(strip.rest, first, end, end_of_piece);
            return sent(P, place_on(tubes_[piece.number - tubes], wide(P), piece.rest, y), false);
        }
        const Found piece = find(y, first, end, end_of_piece);
        if (first < tubes) return on_face(P, faces_[piece.number], strip.rest, piece.rest);
        const size_t number = piece.number - balls;
        // Shifted for each: not all of many are to be asked for the same places.
        const Imath::V2d on_ball(shifted(strip.rest, number, 0), shifted(piece.rest, number, 1));
        return sent(P, place_on(balls_[number], wide(P), on_ball.x, on_ball.y), false);
    }

  private:
    struct Face {
        Face(const LightMesh::Triangle& t, bool both, size_t its_number)
            : triangle(t),
              direction(direction_of(cross_of(t).normalized())),
              number(static_cast<uint32_t>(its_number)),
              two_sided(both) {}
        LightMesh::Triangle triangle;
        uint32_t direction;  ///< of the normal
        uint32_t number;     ///< in places_, if that has any
        bool two_sided;
    };
    /// A part of a list, by area, and how far in it, 0 to 1.
    struct Found {
        size_t number = 0;
        double rest = 0;
    };

    /// Which of the parts first .. end - 1 holds the share x of their area; end_of(i) is the area up to the
    /// end of part i.
    template <class EndOf>
    static Found find(double x, size_t first, size_t end, const EndOf& end_of) {
        const double from = first > 0 ? end_of(first - 1) : 0, at = from + x * (end_of(end - 1) - from);
        size_t low = first, high = end - 1;
        while (low < high) {
            const size_t middle = (low + high) / 2;
            if (at < end_of(middle))
                high = middle;
            else
                low = middle + 1;
        }
        const double before = low > 0 ? end_of(low - 1) : 0;
        return {low, std::clamp((at - before) / (end_of(low) - before), 0.0, 1.0)};
    }

    bool take(double area) {
        if (!(area > 0) || !std::isfinite(area)) return false;
        ends_.push_back((ends_.empty() ? 0 : ends_.back()) + area);
        return true;
    }

    /// Sets strips_, and puts their faces in order.
    void cut() {
        for (size_t i = 0; i < ends_.size(); ++i) {
            const double share = static_cast<double>(strips_.size() + 1) / kStrips;
            // Those of one kind stand together.
            const bool ends =
                i + 1 == faces_.size() || i + 1 == faces_.size() + tubes_.size() || i + 1 == ends_.size();
            if (ends || ends_[i] >= share * ends_.back()) strips_.push_back(i + 1);
        }
        for (size_t first = 0, strip = 0; strip < strips_.size() && first < faces_.size(); ++strip) {
            const auto from = faces_.begin() + static_cast<std::ptrdiff_t>(first);
            first = std::min(strips_[strip], faces_.size());
            std::stable_sort(from, faces_.begin() + static_cast<std::ptrdiff_t>(first), by_normal);
        }
        double sum = 0;
        for (size_t i = 0; i < faces_.size(); ++i) ends_[i] = sum += area_of(faces_[i].triangle);
    }
    double end_of(size_t pieces) const { return ends_[pieces - 1]; }

    static double shifted(double share, size_t number, uint32_t which) {
        const double sum =
            share + static_cast<double>(unit_float(hash(static_cast<uint32_t>(number), which)));
        return sum < 1 ? sum : sum - 1;
    }

    LightSample on_face(const V3f& P, const Face& face, double x, double y) const {
        const LightMesh::Triangle& t = face.triangle;
        const double root = std::sqrt(x), of_a = 1 - root, of_b = root * (1 - y), of_c = root * y;
        const V3d place = wide(t.a) * of_a + wide(t.b) * of_b + wide(t.c) * of_c;
        LightSample made = sent(P, {place, cross_of(t).normalized()}, face.two_sided);
        if (places_.empty()) return made;
        const LightMesh::Place& on = places_[face.number];
        const auto mixed = [&](const std::array<V2f, 3>& corners) {
            return corners[0] * static_cast<float>(of_a) + corners[1] * static_cast<float>(of_b) +
                   corners[2] * static_cast<float>(of_c);
        };
        made.uv = mixed(on.uv), made.st = mixed(on.st);
        made.dPdu = on.dPdu, made.dPdv = on.dPdv;
        return made;
    }

    /// What P gets of a place.
    LightSample sent(const V3f& P, const SurfacePlace& place, bool two_sided) const {
        const V3d way = wide(P) - place.P;
        LightSample made;
        made.P = narrow(place.P);
        const double height = way.dot(place.N), distance2 = way.length2();
        made.N = narrow(two_sided && height < 0 ? -place.N : place.N);
        const double facing = two_sided ? std::abs(height) : std::max(height, 0.0);
        if (facing > 0)
            made.solid_angle = static_cast<float>(ends_.back() * facing / (distance2 * std::sqrt(distance2)));
        return made;
    }

    static V3d cross_of(const LightMesh::Triangle& t) {
        return (wide(t.b) - wide(t.a)).cross(wide(t.c) - wide(t.a));
    }

    static double area_of(const LightMesh::Triangle& t) { return cross_of(t).length() / 2; }
    static bool by_normal(const Face& a, const Face& b) { return a.direction < b.direction; }

    std::vector<Face> faces_;
    std::vector<LightMesh::Place> places_;
    std::vector<LightMesh::Tube> tubes_;
    std::vector<LightMesh::Ball> balls_;
    std::vector<double> ends_;  ///< area of the pieces up to each: faces, tubes, balls
    float roughness_ = 0;
    std::vector<size_t> strips_;  ///< the number of pieces up to the end of each strip
};

}  // namespace

std::unique_ptr<LightSampler> make_mesh_sampler(const LightMesh& mesh, bool two_sided) {
    auto light = std::make_unique<MeshLight>(mesh, two_sided);
    if (!light->is_there()) return {};
    return light;
}

}  // namespace trapeze
