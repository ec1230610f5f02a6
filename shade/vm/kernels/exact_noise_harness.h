/// For tests: noise written out in doubles, a corner of the cell after the other.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace trapeze::testing {

/// The hash of a lattice cell of 1 to 4 coordinates, by the same factors as noise-inl.h: they are written out
/// again, so that a change there does not pass unnoticed. `begin` and `last_factor` are what noise and cell
/// noise differ in.
inline uint32_t hash_of(const std::vector<int64_t>& cell, uint32_t begin, uint32_t last_factor) {
    constexpr uint32_t kFactors[] = {0x8da6b343u, 0xd8163841u, 0xcb1ab31fu, 0x9e3779b1u};
    uint32_t h = begin;
    for (size_t k = 0; k < cell.size(); ++k) h ^= static_cast<uint32_t>(cell[k]) * kFactors[k];
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    return (h ^ h >> 12) * last_factor;
}

/// The gradient that the highest bits stand for, written out.
inline std::vector<double> gradient(uint32_t h, size_t dimensions) {
    const auto sign = [&](int bit) { return h >> bit & 1 ? -1.0 : 1.0; };
    const unsigned four = h >> 28, two = h >> 30;
    switch (dimensions) {
        case 1:
            return {sign(31) * (1 + four % 8)};
        case 2:
            return h >> 29 & 1 ? std::vector{2 * sign(30), sign(31)} : std::vector{sign(31), 2 * sign(30)};
        case 3: {
            std::vector<double> g(3);
            g[four < 8 ? 0 : 1] = sign(28);
            g[four < 4 ? 1 : four == 12 || four == 14 ? 0 : 2] = sign(29);
            return g;
        }
        default: {
            std::vector<double> g(4);
            const double signs[] = {sign(27), sign(28), sign(29)};
            int next = 0;
            for (unsigned axis = 0; axis < 4; ++axis)
                if (axis != 3 - two) g[axis] = signs[next++];
            return g;
        }
    }
}

/// Noise at a point of 1 to 4 dimensions as a sum over the corners of its cell, in doubles: gradient times
/// offset, weighted by the fade 6 t^5 - 15 t^4 + 10 t^3 of [Perlin02]. `period`: empty, or one for each axis.
/// `component`: 0 of a float, 0 to 2 of a triple, which take other bits of the same hash.
inline double exact_noise(const std::vector<double>& x, const std::vector<double>& period, int component) {
    constexpr double kScales[] = {0.0703, 0.1762, 0.3259, 0.3006};
    const size_t n = x.size();
    double sum = 0;
    for (unsigned corner = 0; corner < 1u << n; ++corner) {
        std::vector<int64_t> cell(n);
        std::vector<double> offset(n);
        double weight = 1;
        for (size_t k = 0; k < n; ++k) {
            const int64_t at = static_cast<int64_t>(std::floor(x[k])) + (corner >> k & 1);
            const double f = x[k] - std::floor(x[k]), fade = f * f * f * (f * (f * 6 - 15) + 10);
            offset[k] = x[k] - static_cast<double>(at);
            weight *= corner >> k & 1 ? fade : 1 - fade;
            const int64_t repeat = period.empty() ? 0 : std::max<int64_t>(1, std::floor(period[k]));
            cell[k] = repeat ? (at % repeat + repeat) % repeat : at;
        }
        const auto g = gradient(hash_of(cell, 0, 0x297a2d39u) << (5 * component), n);
        double product = 0;
        for (size_t k = 0; k < n; ++k) product += g[k] * offset[k];
        sum += weight * product;
    }
    return 0.5 + kScales[n - 1] * sum;
}

}  // namespace trapeze::testing
