#include "shade/maps/sky_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/portable_math.h"
#include "shade/maps/read_sky_picture.h"
#include "shade/maps/textures_impl.h"

namespace trapeze {
namespace {

constexpr double kHalfCircle = std::numbers::pi;
/// Cells of a map, across: half as many down. Within one all directions are taken to be one for the mean of a
/// part, so that they are not to be large.
constexpr int kMostColumns = 512, kFewestColumns = 64;
constexpr size_t kMostSkies = 16;
/// Of all light: less is what differences of sums leave of none.
constexpr double kLeastLight = 1e-12;
/// Of a part's side: no half is narrower.
constexpr double kLeastSide = 1e-6;

/// Where a function that grows from `low` to `high`, in a straight line between whole numbers, has a value.
template <class Function>
double place_of(double value, double low, double high, const Function& f) {
    double a = low, b = high;
    for (;;) {
        double middle = std::floor((a + b) / 2);
        if (middle <= a) middle = std::floor(a) + 1;
        if (middle >= b) break;
        (f(middle) < value ? a : b) = middle;
    }
    const double at_a = f(a), at_b = f(b);
    const double place = at_b > at_a ? a + (value - at_a) / (at_b - at_a) * (b - a) : (a + b) / 2;
    const double least = kLeastSide * (high - low);
    return std::clamp(place, low + least, high - least);
}

}  // namespace

SkyParts::SkyParts(const SkyPicture& picture) : width_(picture.width), height_(picture.height) {
    for (int row = 0; row <= height_; ++row) sines_.push_back(portable::cos(kHalfCircle * row / height_));
    const auto columns = static_cast<size_t>(width_) + 1;
    light_.assign(columns * sines_.size(), 0);
    sums_.assign(light_.size(), {});
    for (int row = 0; row < height_; ++row) {
        double of_row = 0;
        std::array<double, kSums> sums_of_row{};
        for (int column = 0; column < width_; ++column) {
            const size_t cell =
                static_cast<size_t>(row) * static_cast<size_t>(width_) + static_cast<size_t>(column);
            const V3f& color = picture.colors[cell];
            const double solid = area(column, column + 1, row, row + 1), light = luminance(color) * solid;
            const V3f middle = way(column + 0.5, row + 0.5);
            of_row += light;
            for (int k = 0; k < 3; ++k) {
                sums_of_row[kColor + static_cast<size_t>(k)] += static_cast<double>(color[k]) * solid;
                sums_of_row[kWay + static_cast<size_t>(k)] += static_cast<double>(middle[k]) * light;
            }
            const size_t above = static_cast<size_t>(row) * columns + static_cast<size_t>(column) + 1,
                         below = above + columns;
            light_[below] = light_[above] + of_row;
            for (size_t k = 0; k < kSums; ++k) sums_[below][k] = sums_[above][k] + sums_of_row[k];
        }
    }
}

std::shared_ptr<const SkyParts> Textures::sky_parts(std::string_view name, SourceLocation location) {
    const std::lock_guard lock(impl_->skies_mutex);
    const auto known = impl_->skies.find(name);
    if (known != impl_->skies.end()) return known->second;
    const SkyPicture picture = read_sky_picture(*this, name, location, kMostColumns, kFewestColumns);
    if (impl_->skies.size() >= kMostSkies) impl_->skies.clear();
    std::shared_ptr<const SkyParts>& made = impl_->skies[std::string(name)];
    if (!picture.colors.empty()) made = std::make_shared<const SkyParts>(picture);
    return made;
}

SkyParts::Corner SkyParts::corner(double x, double y) const {
    const int column = std::clamp(static_cast<int>(x), 0, width_ - 1),
              row = std::clamp(static_cast<int>(y), 0, height_ - 1);
    return {static_cast<size_t>(row) * (static_cast<size_t>(width_) + 1) + static_cast<size_t>(column),
            x - column, y - row};
}

double SkyParts::height_at(double y) const {
    const int row = std::clamp(static_cast<int>(y), 0, height_ - 1);
    const double above = sines_[static_cast<size_t>(row)], below = sines_[static_cast<size_t>(row) + 1];
    return above + (y - row) * (below - above);
}

double SkyParts::area(double x0, double x1, double y0, double y1) const {
    return (x1 - x0) * (height_at(y0) - height_at(y1)) * 2 * kHalfCircle / width_;
}

double SkyParts::light_up_to(double x, double y) const {
    const Corner c = corner(x, y);
    const size_t next = static_cast<size_t>(width_) + 1;
    const double top = light_[c.at] + c.x * (light_[c.at + 1] - light_[c.at]);
    const double bottom = light_[c.at + next] + c.x * (light_[c.at + next + 1] - light_[c.at + next]);
    return top + c.y * (bottom - top);
}

double SkyParts::light(double x0, double x1, double y0, double y1) const {
    return (light_up_to(x1, y1) - light_up_to(x0, y1)) - (light_up_to(x1, y0) - light_up_to(x0, y0));
}

double SkyParts::sum_up_to(size_t which, double x, double y) const {
    const Corner c = corner(x, y);
    const size_t next = static_cast<size_t>(width_) + 1;
    const auto at = [&](size_t i) { return sums_[i][which]; };
    const double top = at(c.at) + c.x * (at(c.at + 1) - at(c.at));
    const double bottom = at(c.at + next) + c.x * (at(c.at + next + 1) - at(c.at + next));
    return top + c.y * (bottom - top);
}

double SkyParts::sum(size_t which, const Part& p) const {
    return (sum_up_to(which, p.x1, p.y1) - sum_up_to(which, p.x0, p.y1)) -
           (sum_up_to(which, p.x1, p.y0) - sum_up_to(which, p.x0, p.y0));
}

bool SkyParts::is_lit(double light) const {
    return light > kLeastLight * light_.back();
}

double SkyParts::measure(double x0, double x1, double y0, double y1, bool lit) const {
    return lit ? light(x0, x1, y0, y1) : area(x0, x1, y0, y1);
}

/// Where a part is cut so that its first half has a share of its light.
double SkyParts::split(const Part& p, bool across, double share) const {
    const bool lit = is_lit(light(p.x0, p.x1, p.y0, p.y1));
    const double wanted = share * measure(p.x0, p.x1, p.y0, p.y1, lit);
    if (across)
        return place_of(wanted, p.x0, p.x1, [&](double x) { return measure(p.x0, x, p.y0, p.y1, lit); });
    return place_of(wanted, p.y0, p.y1, [&](double y) { return measure(p.x0, p.x1, p.y0, y, lit); });
}

/// Each cut is across the longer side.
SkyParts::Part SkyParts::part(int number, int count) const {
    Part p{0, static_cast<double>(width_), 0, static_cast<double>(height_)};
    while (count > 1) {
        const int first = count / 2;
        const double top = height_at(p.y0), bottom = height_at(p.y1);
        const double least = top > 0 && bottom < 0 ? 0 : std::min(std::abs(top), std::abs(bottom));
        const double wide = (p.x1 - p.x0) * 2 / width_ * std::sqrt(std::max(0.0, 1 - least * least));
        const bool across = wide > (p.y1 - p.y0) / height_;
        const double cut = split(p, across, static_cast<double>(first) / count);
        const bool in_first = number < first;
        if (in_first)
            (across ? p.x1 : p.y1) = cut;
        else
            (across ? p.x0 : p.y0) = cut;
        number -= in_first ? 0 : first;
        count = in_first ? first : count - first;
    }
    const double solid = area(p.x0, p.x1, p.y0, p.y1);
    p.solid_angle = static_cast<float>(solid);
    V3d mean(0, 0, 0);
    for (int k = 0; k < 3; ++k) {
        p.color[k] = static_cast<float>(std::max(0.0, sum(kColor + static_cast<size_t>(k), p) / solid));
        mean[k] = sum(kWay + static_cast<size_t>(k), p);
    }
    const double length = mean.length(), all = light(p.x0, p.x1, p.y0, p.y1);
    // Light from all sides has no mean.
    if (is_lit(all) && length > 1e-3 * all)
        p.direction = V3f(static_cast<float>(mean.x / length), static_cast<float>(mean.y / length),
                          static_cast<float>(mean.z / length));
    else
        p.direction = way((p.x0 + p.x1) / 2, (p.y0 + p.y1) / 2);
    return p;
}

V3f SkyParts::direction_in(const Part& p, const V2f& square) const {
    bool lit = is_lit(light(p.x0, p.x1, p.y0, p.y1));
    const double x = place_of(static_cast<double>(square.x) * measure(p.x0, p.x1, p.y0, p.y1, lit), p.x0,
                              p.x1, [&](double to) { return measure(p.x0, to, p.y0, p.y1, lit); });
    const double column = std::clamp(std::floor(x), 0.0, static_cast<double>(width_ - 1));
    lit = lit && is_lit(light(column, column + 1, p.y0, p.y1));
    const auto down_to = [&](double to) { return measure(column, column + 1, p.y0, to, lit); };
    return way(x, place_of(static_cast<double>(square.y) * down_to(p.y1), p.y0, p.y1, down_to));
}

V3f SkyParts::way(double x, double y) const {
    const double z = height_at(y), across = std::sqrt(std::max(0.0, 1 - z * z));
    const double turn = 2 * kHalfCircle * x / width_;
    return {static_cast<float>(across * portable::cos(turn)),
            static_cast<float>(across * portable::sin(turn)), static_cast<float>(z)};
}

}  // namespace trapeze
