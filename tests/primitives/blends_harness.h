/// For tests: the bases of cubic patches and curves (RISpec 5.2), their blending functions written out one by
/// one.
#pragma once

#include <array>
#include <string>

namespace trapeze::testing {

/// Weights of four control points at t.
using Blend = std::array<double, 4> (*)(double t);

struct NamedBasis {
    const char* name;
    int step;
    Blend blend;
    bool is_affine;  ///< weights sum to 1
};

inline const NamedBasis kBases[] = {
    {"bezier", 3,
     [](double t) {
         const double s = 1 - t;
         return std::array{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
     },
     true},
    {"b-spline", 1,
     [](double t) {
         const double s = 1 - t;
         return std::array{s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                           (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6};
     },
     true},
    {"catmull-rom", 1,
     [](double t) {
         // Hermite, with half the neighbours' difference as tangents.
         const double h00 = (1 + 2 * t) * (1 - t) * (1 - t), h10 = t * (1 - t) * (1 - t);
         const double h01 = t * t * (3 - 2 * t), h11 = t * t * (t - 1);
         return std::array{-h10 / 2, h00 - h11 / 2, h01 + h10 / 2, h11 / 2};
     },
     true},
    {"hermite", 2,
     [](double t) {
         return std::array{(1 + 2 * t) * (1 - t) * (1 - t), t * (1 - t) * (1 - t), t * t * (3 - 2 * t),
                           t * t * (t - 1)};
     },
     false},
    {"power", 4,
     [](double t) {
         return std::array{t * t * t, t * t, t, 1.0};
     },
     false},
};

inline std::string basis_text(const NamedBasis& u, const NamedBasis& v, bool with_steps) {
    const auto one = [&](const NamedBasis& b) {
        return '"' + std::string(b.name) + "\" " + (with_steps ? std::to_string(b.step) + " " : "");
    };
    return "Basis " + one(u) + one(v);
}

/// As RIB: six decimals.
inline std::string decimal(double value) {
    return std::to_string(value) + " ";
}

}  // namespace trapeze::testing
