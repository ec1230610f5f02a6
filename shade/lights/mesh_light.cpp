// Lights of any shape: triangles, sampled by their area.
#include <algorithm>

#include "shade/lights/light_sampler.h"
#include "shade/lights/sphere_space.h"

namespace trapeze {
namespace {

class MeshLight final : public LightSampler {
  public:
    MeshLight(const LightMesh& mesh, bool two_sided) : two_sided_(two_sided) {
        double sum = 0;
        for (const LightMesh::Triangle& t : mesh.triangles) {
            const double area = cross_of(t).length() / 2;
            if (!(area > 0) || !std::isfinite(area)) continue;
            sum += area;
            triangles_.push_back(t);
            ends_.push_back(sum);
        }
    }

    bool is_there() const { return !ends_.empty() && std::isfinite(ends_.back()); }
    float area() const override { return static_cast<float>(ends_.back()); }

    /// The square's x chooses the triangle, and what is left of it the place along it: points that are well
    /// apart there are so on the mesh, whose triangles follow each other grid by grid.
    LightSample sample(const V3f& P, const V3f&, const V2f& square) const override {
        const double at = static_cast<double>(square.x) * ends_.back();
        const auto found = std::min(std::upper_bound(ends_.begin(), ends_.end(), at), ends_.end() - 1);
        const auto number = static_cast<size_t>(found - ends_.begin());
        const double before = number > 0 ? ends_[number - 1] : 0;
        const double x = std::clamp((at - before) / (ends_[number] - before), 0.0, 1.0), root = std::sqrt(x),
                     y = static_cast<double>(square.y);
        const LightMesh::Triangle& t = triangles_[number];
        const V3d place = wide(t.a) * (1 - root) + wide(t.b) * (root * (1 - y)) + wide(t.c) * (root * y);
        const V3d normal = cross_of(t).normalized(), way = wide(P) - place;
        LightSample made;
        made.P = narrow(place);
        const double height = way.dot(normal), distance2 = way.length2();
        made.N = narrow(two_sided_ && height < 0 ? -normal : normal);
        const double facing = two_sided_ ? std::abs(height) : std::max(height, 0.0);
        if (facing > 0)
            made.solid_angle = static_cast<float>(ends_.back() * facing / (distance2 * std::sqrt(distance2)));
        return made;
    }

  private:
    static V3d cross_of(const LightMesh::Triangle& t) {
        return (wide(t.b) - wide(t.a)).cross(wide(t.c) - wide(t.a));
    }

    std::vector<LightMesh::Triangle> triangles_;
    std::vector<double> ends_;  ///< area of the triangles up to each
    bool two_sided_;
};

}  // namespace

std::unique_ptr<LightSampler> make_mesh_sampler(const LightMesh& mesh, bool two_sided) {
    auto light = std::make_unique<MeshLight>(mesh, two_sided);
    if (!light->is_there()) return {};
    return light;
}

}  // namespace trapeze
