#include "pipeline/study/scenes/cage.h"

#include <array>
#include <cmath>

#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {

int Cage::add(const V3d& point, const V3d& color) {
    points.push_back(point);
    colors.push_back(color);
    return static_cast<int>(points.size()) - 1;
}

void Cage::face(const Integers& points_of_face) {
    sizes.push_back(static_cast<int>(points_of_face.size()));
    corners.insert(corners.end(), points_of_face.begin(), points_of_face.end());
}

void Cage::crease(const Integers& chain, double sharpness) {
    if (sharpness > 0) creases.push_back({chain, sharpness});
}

void Cage::write(RibWriter& rib) const {
    Words tags{"interpolateboundary"};
    Integers counts{0, 0}, integers;
    Numbers sharpness;
    for (const Crease& crease : creases) {
        tags.emplace_back("crease");
        counts.insert(counts.end(), {static_cast<int>(crease.chain.size()), 1});
        integers.insert(integers.end(), crease.chain.begin(), crease.chain.end());
        sharpness.push_back(crease.sharpness);
    }
    if (!holes.empty()) {
        tags.emplace_back("hole");
        counts.insert(counts.end(), {static_cast<int>(holes.size()), 0});
        integers.insert(integers.end(), holes.begin(), holes.end());
    }
    const auto write = [&](const auto&... variables) {
        rib.request("SubdivisionMesh", "catmull-clark", sizes, corners, tags, counts, integers, sharpness,
                    "P", flattened(points), variables...);
    };
    colors.empty() ? write() : write("vertex color Cs", flattened(colors));
}

void add_lathe(Cage& cage, const Lathe& lathe, const std::vector<Ring>& rings) {
    const auto n = static_cast<size_t>(lathe.sides);
    std::vector<Integers> loops;  ///< of each ring n points, a pole n times
    for (const Ring& ring : rings) {
        Integers loop;
        for (size_t i = 0; i < n; ++i) {
            const double angle = 2 * kPi * static_cast<double>(i) / lathe.sides;
            const V3d place(ring.radius * lathe.width * std::cos(angle), ring.y,
                            ring.radius * lathe.depth * std::sin(angle));
            loop.push_back(ring.radius > 0 || i == 0 ? cage.add(place, ring.color) : loop[0]);
        }
        Integers closed = loop;
        closed.push_back(loop[0]);
        if (ring.radius > 0) cage.crease(closed, ring.sharpness);
        loops.push_back(loop);
    }
    for (size_t r = 1; r < rings.size(); ++r)
        for (size_t i = 0; i < n; ++i) {
            const size_t next = (i + 1) % n;
            const Integers &low = loops[r - 1], &high = loops[r];
            Integers face{low[i]};
            if (rings[r - 1].radius > 0) face.push_back(low[next]);
            if (rings[r].radius > 0) face.push_back(high[next]);
            face.push_back(high[i]);
            cage.face(face);
            cage.crease({low[i], high[i]}, lathe.ridges);
        }
    if (rings.front().radius > 0) cage.face({loops.front().rbegin(), loops.front().rend()});
    if (rings.back().radius > 0) cage.face(loops.back());
}

void add_stud(Cage& cage, const V3d& center, double radius, const V3d& color) {
    const double half = radius;
    Integers corner;
    for (int i = 0; i < 8; ++i)
        corner.push_back(
            cage.add(center + V3d(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half), color));
    constexpr std::array<std::array<size_t, 4>, 6> kSides = {
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& side : kSides)
        cage.face({corner[side[0]], corner[side[1]], corner[side[2]], corner[side[3]]});
}

namespace {

class PlateBuilder {
  public:
    PlateBuilder(Cage& cage, const Plate& plate) : cage_(cage), plate_(plate) {}

    void build() {
        add_points();
        for (int r = 0; r + 1 < plate_.rows; ++r)
            for (int c = 0; c + 1 < plate_.columns; ++c)
                if (filled(r, c)) add_cell(r, c);
    }

  private:
    void add_points() {
        for (int r = 0; r < plate_.rows; ++r)
            for (int c = 0; c < plate_.columns; ++c) {
                const Plate::Point p = plate_.point(r, c);
                const V3d middle(p.x, p.y, plate_.z), half(0, 0, p.half_thickness);
                front_.push_back(cage_.add(middle - half, p.color));
                back_.push_back(p.half_thickness > 0 ? cage_.add(middle + half, p.color) : front_.back());
                ridge_.push_back(p.ridge);
            }
    }

    size_t at(int row, int column) const { return static_cast<size_t>(row * plate_.columns + column); }
    bool filled(int row, int column) const {
        return row >= 0 && column >= 0 && row + 1 < plate_.rows && column + 1 < plate_.columns &&
               !plate_.hole(row, column);
    }

    void add_cell(int r, int c) {
        const size_t a = at(r, c), b = at(r, c + 1), d = at(r + 1, c + 1), e = at(r + 1, c);
        cage_.face({front_[a], front_[b], front_[d], front_[e]});
        cage_.face({back_[e], back_[d], back_[b], back_[a]});
        if (!filled(r - 1, c)) add_border(a, b);
        if (!filled(r, c + 1)) add_border(b, d);
        if (!filled(r + 1, c)) add_border(d, e);
        if (!filled(r, c - 1)) add_border(e, a);
        // A line between two cells is given to the one after it.
        if (filled(r, c - 1)) {
            cage_.crease({front_[a], front_[e]}, ridge_[a]);
            cage_.crease({back_[a], back_[e]}, ridge_[a]);
        }
    }

    /// Adds a wall from the front sheet to the back one, at the side of a cell that goes round from point `i`
    /// to `j`.
    void add_border(size_t i, size_t j) {
        const bool thin_i = front_[i] == back_[i], thin_j = front_[j] == back_[j];
        if (thin_i && thin_j) return cage_.crease({front_[i], front_[j]}, plate_.edge);
        Integers wall{front_[j], front_[i]};
        if (!thin_i) wall.push_back(back_[i]);
        if (!thin_j) wall.push_back(back_[j]);
        cage_.face(wall);
        cage_.crease({front_[i], front_[j]}, plate_.rim);
        cage_.crease({back_[i], back_[j]}, plate_.rim);
    }

    Cage& cage_;
    const Plate& plate_;
    Integers front_, back_;
    Numbers ridge_;
};

}  // namespace

void add_plate(Cage& cage, const Plate& plate) {
    PlateBuilder(cage, plate).build();
}

}  // namespace trapeze::scenes
