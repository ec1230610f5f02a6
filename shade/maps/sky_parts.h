/// An environment map in parts that send as much light each: its importance, for gather("environment:MAP").
/// Halves of halves, as the median cut has it [Debevec, "A Median Cut Algorithm for Light Probe Sampling",
/// SIGGRAPH 2005 posters]. The map's own space, z up.
#pragma once

#include <array>
#include <vector>

#include "shade/lights/sky_picture.h"

namespace trapeze {

/// Sums over a map, of which any part is found in a few steps. Immutable: threads share it.
class SkyParts {
  public:
    /// The picture is not empty.
    explicit SkyParts(const SkyPicture& picture);

    /// Columns x0 to x1 and rows y0 to y1 of the picture's cells; of a cell that is cut as much of its solid
    /// angle as of its side.
    struct Part {
        double x0 = 0, x1 = 0, y0 = 0, y1 = 0;
        V3f color{0, 0, 0};      ///< the mean over the part
        V3f direction{0, 0, 1};  ///< the mean, by light; of unit length
        float solid_angle = 0;
    };
    /// One of `count` parts that cover the sphere: each sends as much light, but where there is none they are
    /// as large.
    Part part(int number, int count) const;

    /// A direction within a part, as likely as light comes from it, for a point of the unit square.
    V3f direction_in(const Part& part, const V2f& square) const;

  private:
    /// What is summed besides the light.
    enum : size_t { kColor = 0, kWay = 3, kSums = 6 };
    struct Corner {
        size_t at;
        double x, y;  ///< the place in the cell that begins there
    };
    Corner corner(double x, double y) const;
    double light(double x0, double x1, double y0, double y1) const;
    double light_up_to(double x, double y) const;
    double sum(size_t which, const Part& part) const;
    double sum_up_to(size_t which, double x, double y) const;
    double area(double x0, double x1, double y0, double y1) const;
    double height_at(double y) const;
    bool is_lit(double light) const;
    double measure(double x0, double x1, double y0, double y1, bool lit) const;
    double split(const Part& part, bool across, double share) const;
    V3f way(double x, double y) const;

    int width_, height_;
    std::vector<double> sines_;  ///< of the latitudes above each row, and below the last
    // Sums over the cells above and to the left of each corner, row by row.
    std::vector<double> light_;
    std::vector<std::array<double, kSums>> sums_;
};

}  // namespace trapeze
