/// Noise and periodic noise, cell noise and random numbers.
#include "shade/vm/kernels/families.h"
#include "shade/vm/kernels/random.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/vm/kernels/noise.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/vm/kernels/noise-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

using rsl::Op;

/// One coordinate of a point that may be given as floats, a triple, or a triple and a float.
struct Coordinate {
    HWY_INLINE V get(size_t i) const { return Input(*operand).get(i, component); }

    const Operand* operand = nullptr;
    int component = 0;
};

/// Coordinates of the point that operands o[0] and on hold: one or two floats; a triple; or a triple and a
/// float.
template <int dimensions>
std::array<Coordinate, dimensions> coordinates(Operands o) {
    std::array<Coordinate, dimensions> result;
    for (int k = 0; k < dimensions; ++k)
        result[k] = dimensions < 3 ? Coordinate{&o[k], 0}
                    : k < 3        ? Coordinate{&o[0], k}
                                   : Coordinate{&o[1], 0};
    return result;
}

/// Operands that hold a point of so many dimensions: f, ff, t or tf.
constexpr size_t operand_count(int dimensions) {
    return dimensions == 2 || dimensions == 4 ? 2 : 1;
}

/// noise() and pnoise(). Periods are whole numbers, at least 1, and may differ from lane to lane.
template <bool periodic, int dimensions, int width>
void noise_kernel(size_t lanes, Operands o) {
    const Output out(o[0]);
    const auto point = coordinates<dimensions>(o.subspan(1));
    const auto periods = coordinates<dimensions>(o.subspan(periodic ? 1 + operand_count(dimensions) : 1));
    for (size_t i = 0; i < lanes; i += lane_count()) {
        NoiseAxis axes[dimensions];
        for (int k = 0; k < dimensions; ++k) {
            V period = set(1);
            if constexpr (periodic) period = at_least(hn::Floor(clamp_to_lattice(periods[k].get(i))), period);
            axes[k] = noise_axis<periodic>(point[k].get(i), period, kAxisFactors[k]);
        }
        // One walk over the cell's corners makes all components.
        V values[width];
        gradient_noise(axes, values);
        for (int k = 0; k < width; ++k) out.put(values[k], i, k);
    }
}

/// Constant in each cell, uniform in [0, 1). Coordinates are clamped to what 32 bits hold; NaN is the last.
template <int dimensions, int width>
void cell_noise(size_t lanes, Operands o) {
    const DU du;
    const Output out(o[0]);
    const auto point = coordinates<dimensions>(o.subspan(1));
    for (size_t i = 0; i < lanes; i += lane_count()) {
        VU h = hn::Set(du, 0x3c6ef372u);  // other cells than noise's lattice
        for (int k = 0; k < dimensions; ++k) {
            const V x = at_least(at_most(point[k].get(i), set(2147483520)), set(-2147483520));
            const VU cell = hn::BitCast(du, hn::ConvertTo(DI(), hn::Floor(x)));
            h = hn::Xor(h, hn::Mul(cell, hn::Set(du, kAxisFactors[k])));
        }
        for (int k = 0; k < width; ++k) out.put(unit_float(mix_bits(h, kComponentFactors[k])), i, k);
    }
}

/// Counter-based numbers: a hash of who asks in place of a state, so that lanes need not know of each other
/// and a picture does not depend on the order in which grids are shaded.
void fill_random(size_t lanes, int width, const Operand& lane_seeds, uint32_t call, const Operand& result) {
    const DU du;
    const Output out(result);
    const Input seeds(lane_seeds);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const VU lane = hn::BitCast(du, seeds.get(i));
        for (int k = 0; k < width; ++k) {
            const uint32_t word = (call * 3 + static_cast<uint32_t>(k)) * 0x9e3779b1u + 0x7f4a7c15u;
            // Two rounds more, since seeds and calls are small neighbouring numbers.
            const VU h = mix_bits(hn::Xor(mix_bits(lane), hn::Set(du, word)));
            out.put(unit_float(h), i, k);
        }
    }
}

/// 1 to 4 for inputs of these widths, which may hold periods, too; 0 for others.
int dimensions_of(std::span<const int> inputs) {
    if (are(inputs, {1})) return 1;
    if (are(inputs, {1, 1})) return 2;
    if (are(inputs, {3})) return 3;
    return are(inputs, {3, 1}) ? 4 : 0;
}

/// The number of dimensions becomes part of the kernel's type, so that its loops over them are unrolled.
template <bool periodic, int width>
Kernel find_noise(int dimensions) {
    switch (dimensions) {
        case 1:
            return noise_kernel<periodic, 1, width>;
        case 2:
            return noise_kernel<periodic, 2, width>;
        case 3:
            return noise_kernel<periodic, 3, width>;
        case 4:
            return noise_kernel<periodic, 4, width>;
        default:
            return nullptr;
    }
}

/// As find_noise(), for cells.
template <int width>
Kernel find_cell_noise(int dimensions) {
    switch (dimensions) {
        case 1:
            return cell_noise<1, width>;
        case 2:
            return cell_noise<2, width>;
        case 3:
            return cell_noise<3, width>;
        case 4:
            return cell_noise<4, width>;
        default:
            return nullptr;
    }
}

/// The output's width is that of the result: float or triple.
Kernel choose_noise(std::span<const int> widths) {
    const int dimensions = dimensions_of(widths.subspan(1));
    if (widths[0] == 1) return find_noise<false, 1>(dimensions);
    return widths[0] == 3 ? find_noise<false, 3>(dimensions) : nullptr;
}

Kernel choose_cell_noise(std::span<const int> widths) {
    const int dimensions = dimensions_of(widths.subspan(1));
    if (widths[0] == 1) return find_cell_noise<1>(dimensions);
    return widths[0] == 3 ? find_cell_noise<3>(dimensions) : nullptr;
}

/// Coordinates, then as many periods of the same widths.
Kernel choose_periodic_noise(std::span<const int> widths) {
    const auto inputs = widths.subspan(1);
    if (inputs.size() % 2 != 0) return nullptr;
    const auto point = inputs.first(inputs.size() / 2), period = inputs.last(inputs.size() / 2);
    if (!std::equal(point.begin(), point.end(), period.begin())) return nullptr;
    const int dimensions = dimensions_of(point);
    if (widths[0] == 1) return find_noise<true, 1>(dimensions);
    return widths[0] == 3 ? find_noise<true, 3>(dimensions) : nullptr;
}

constexpr KernelRow kRows[] = {
    {Op::Noise, choose_noise},
    {Op::CellNoise, choose_cell_noise},
    {Op::PeriodicNoise, choose_periodic_noise},
};

Kernel find_noises(Op op, std::span<const int> widths) {
    return kernel_in(kRows, op, widths);
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze::vm {

HWY_EXPORT(fill_random);

void random_numbers(size_t lanes, int width, const Operand& lane_seeds, uint32_t call, const Operand& out) {
    HWY_DYNAMIC_DISPATCH(fill_random)(lanes, width, lane_seeds, call, out);
}

}  // namespace trapeze::vm

TRAPEZE_KERNEL_FAMILY(find_noises)
#endif
