// Lights that are nowhere: disks in the sky, and domes.
#include <algorithm>
#include <span>
#include <utility>

#include "shade/lights/light_sampler.h"
#include "shade/lights/sphere_space.h"

namespace trapeze {
namespace {

/// Solid angles are those that make a face which is turned to the disk as bright as the light's colour says:
/// pi for the disk's cosines together.
class DistantLight final : public LightSampler {
  public:
    DistantLight(float angle, const V3d& along)
        : axes_(-along), rim_(1 - portable::cos(std::clamp(static_cast<double>(angle), 0.0, kPi64 / 2))) {
        // Differences of cosines lose the digits of small angles.
        const double sine = portable::sin(std::clamp(static_cast<double>(angle), 0.0, kPi64 / 2));
        if (sine < 0.5) rim_ = one_minus_cosine(sine * sine);
    }

    bool is_point() const override { return rim_ == 0; }

    LightSample sample(const V3f&, const V3f&, const V2f& square) const override {
        LightSample made;
        made.N = narrow(-in_cone(axes_, rim_, square));
        made.solid_angle = static_cast<float>(2 * kPi64 / (2 - rim_));
        return made;
    }

  private:
    AxesAround<double> axes_;
    double rim_;  ///< one_minus_cosine() of the angle
};

/// The part of a white dome's points that follow the cosine to the normal; others are even over the sphere,
/// for surfaces that ask for other sides.
constexpr double kByCosine = 0.75;

class WhiteDome final : public LightSampler {
  public:
    LightSample sample(const V3f&, const V3f& N, const V2f& square) const override {
        V3d way;
        V2f rest = square;
        const double length = wide(N).length();
        const bool knows_normal = length > 0 && std::isfinite(length);
        const V3d normal = knows_normal ? wide(N) / length : V3d(0);
        const double share = knows_normal ? kByCosine : 0;
        if (static_cast<double>(square.x) < share) {
            const double sine2 = static_cast<double>(square.x) / share;
            way = AxesAround(normal).around(std::sqrt(sine2), std::sqrt(1 - sine2),
                                            static_cast<double>(square.y));
        } else {
            rest.x = static_cast<float>((static_cast<double>(square.x) - share) / (1 - share));
            way = in_cone(AxesAround(V3d(0, 0, 1)), 2, rest);
        }
        const double density = share * std::max(0.0, normal.dot(way)) / kPi64 + (1 - share) / (4 * kPi64);
        LightSample made;
        made.N = narrow(-way);
        made.solid_angle = static_cast<float>(1 / density);
        return made;
    }
};

/// The cells of a dome's picture, which are chosen by what they send; within a cell all solid angles are
/// alike.
class DomeCells {
  public:
    explicit DomeCells(SkyPicture map) : map_(std::move(map)) {
        double sum = 0;
        for (int row = 0; row < map_.height; ++row) {
            double of_row = 0;
            for (int column = 0; column < map_.width; ++column) {
                of_row += luminance(color(row, column)) * cell(row);
                row_sums_.push_back(of_row);
            }
            sum += of_row;
            sums_.push_back(sum);
        }
    }

    bool is_there() const { return !sums_.empty() && sums_.back() > 0 && std::isfinite(sums_.back()); }

    /// A direction of unit length, and what comes from there.
    struct Place {
        V3d way{0, 0, 1};
        V3f radiance{0, 0, 0};
        double solid_angle = 0;  ///< that it stands for
    };
    Place choose(const V2f& square) const {
        const auto [row, y] = choose(std::span(sums_), static_cast<double>(square.y));
        const auto width = static_cast<size_t>(map_.width);
        const auto [column, x] = choose(std::span(row_sums_).subspan(static_cast<size_t>(row) * width, width),
                                        static_cast<double>(square.x));
        const double height = sine_at(row) + y * (sine_at(row + 1) - sine_at(row));
        const double turn = 2 * kPi64 * (column + x) / map_.width,
                     across = std::sqrt(std::max(0.0, 1 - height * height));
        const V3f radiance = color(row, column);
        return {V3d(across * portable::cos(turn), across * portable::sin(turn), height), radiance,
                sums_.back() / luminance(radiance)};
    }

  private:
    const V3f& color(int row, int column) const {
        return map_
            .colors[static_cast<size_t>(row) * static_cast<size_t>(map_.width) + static_cast<size_t>(column)];
    }
    /// Sine of the latitude above a row.
    double sine_at(int row) const { return portable::cos(kPi64 * row / map_.height); }
    /// Solid angle of a cell.
    double cell(int row) const { return (sine_at(row) - sine_at(row + 1)) * 2 * kPi64 / map_.width; }

    /// The number of a part, as likely as it is large, and the place in it, 0 to 1.
    static std::pair<int, double> choose(std::span<const double> sums, double of_all) {
        const double at = of_all * sums.back();
        auto found = std::upper_bound(sums.begin(), sums.end(), at);
        if (found == sums.end()) found = std::lower_bound(sums.begin(), sums.end(), sums.back());
        const double before = found == sums.begin() ? 0 : *(found - 1);
        return {static_cast<int>(found - sums.begin()),
                std::clamp((at - before) / (*found - before), 0.0, 1.0)};
    }

    SkyPicture map_;
    std::vector<double> sums_;      ///< up to each row
    std::vector<double> row_sums_;  ///< within its row, up to each cell
};

/// A dome's cells in a space: where it turns while the shutter is open, many have the same.
class MappedDome final : public LightSampler {
  public:
    MappedDome(std::shared_ptr<const DomeCells> cells, const LinearSpace& camera_from_light)
        : cells_(std::move(cells)), space_(camera_from_light) {}

    LightSample sample(const V3f&, const V3f&, const V2f& square) const override {
        const DomeCells::Place place = cells_->choose(square);
        LightSample made;
        made.N = narrow(-space_.to_camera(place.way).normalized());
        made.radiance = place.radiance;
        made.solid_angle = static_cast<float>(place.solid_angle * space_.stretch(place.way));
        return made;
    }

  private:
    std::shared_ptr<const DomeCells> cells_;
    LinearSpace space_;
};

}  // namespace

std::unique_ptr<LightSampler> make_distant_sampler(float angle, const M44f& camera_from_light) {
    const V3d along = wide({camera_from_light[2][0], camera_from_light[2][1], camera_from_light[2][2]});
    const double length = along.length();
    if (!(length > 0) || !std::isfinite(length)) return {};
    return std::make_unique<DistantLight>(angle, along / length);
}

std::vector<std::unique_ptr<LightSampler>> make_dome_samplers(SkyPicture map,
                                                              std::span<const M44f> camera_from_light) {
    std::vector<std::unique_ptr<LightSampler>> samplers(camera_from_light.size());
    if (map.colors.empty()) {
        for (auto& sampler : samplers) sampler = std::make_unique<WhiteDome>();
        return samplers;
    }
    const auto cells = std::make_shared<const DomeCells>(std::move(map));
    for (size_t i = 0; i < samplers.size(); ++i) {
        const LinearSpace space(camera_from_light[i]);
        if (cells->is_there() && space.is_regular()) samplers[i] = std::make_unique<MappedDome>(cells, space);
    }
    return samplers;
}

}  // namespace trapeze
