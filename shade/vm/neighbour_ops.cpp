// Operations that look at the vertices next to each one, and depth().
#include <algorithm>
#include <cmath>
#include <numeric>

#include "shade/vm/context_ops.h"
#include "shade/vm/kernels/neighbours.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// The grids of the batch; none where shaders run over no points, and then nothing has neighbours.
GridSpans spans_of(const Run& run) {
    const Batch* batch = run.context().batch;
    return batch ? GridSpans(batch->spans) : GridSpans();
}

/// 1 or 3: the kernels of differences take the width as an argument, and not from their operands.
int width_of_output(Run& run, const Step& step) {
    return rsl::width_of(run.registers().reg(run.registers().register_of(step, 0)).type.base);
}

/// What is the same at all vertices does not change from one to the next. A uniform output says that all
/// inputs are uniform (infer_storage.h), and then the output, zero, is filled in here.
bool is_flat(Run& run, const Step& step, std::span<const Operand> operands) {
    if (operands[0].lane_mask) return false;
    const std::array<float, 3> zeros{};
    fill_operand(run, operands[0], std::span(zeros).first(static_cast<size_t>(width_of_output(run, step))));
    return true;
}

/// Du(), Dv() and Deriv(), with u and v behind their arguments (kNeedsUV).
void differences(Run& run, const Step& step, std::span<const Operand> operands) {
    if (is_flat(run, step, operands)) return;
    const int width = width_of_output(run, step);
    if (step.op == Op::Deriv)
        return derivative(spans_of(run), run.lanes(), width, operands[1], operands[2], operands[3],
                          operands[4], operands[0]);
    const auto differentiate = step.op == Op::Du ? derivative_u : derivative_v;
    differentiate(spans_of(run), run.lanes(), width, operands[1], operands[2], operands[3], operands[0]);
}

/// area(P): as large as what the vertex stands for where it is filtered, which at grazing angles is more than
/// the micropolygon (Footprint::widening). area(P, "dicing"): as large as the micropolygon.
void area(Run& run, const Step& step, std::span<const Operand> operands) {
    if (is_flat(run, step, operands)) return;
    areas(spans_of(run), run.lanes(), operands[1], operands[0]);
    const bool of_dicing = step.count > 2 && run.registers().text_input(step, 1) == "dicing";
    if (of_dicing || !run.context().footprints) return;
    const float* const widening = run.context().footprints->get().widening;
    for (size_t i = 0; i < run.lanes(); ++i) operands[0].data[i] *= widening[i];
}

/// Of numbers in order, so that it does not depend on how many are added at once.
float mean_of(std::span<const float> values) {
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    return static_cast<float>(sum / static_cast<double>(values.size()));
}

/// gridmin(x), gridmax(x) and gridavg(x): of all vertices of the grid, whatever block of the shader they are
/// in.
void of_grid(Run& run, const Step& step, std::span<const Operand> operands) {
    const Operand &out = operands[0], &x = operands[1];
    if (!out.lane_mask) return fill_operand(run, out, std::span(x.data, 1));
    // What belongs to no grid has no others beside it.
    for (size_t i = 0; i < run.lanes(); ++i) out.data[i] = Run::at(x, 0, i);
    for (const GridSpan& span : spans_of(run)) {
        const std::span values(out.data + span.first, static_cast<size_t>(span.shape.vertex_count()));
        std::ranges::fill(values, step.op == Op::GridMin   ? *std::ranges::min_element(values)
                                  : step.op == Op::GridMax ? *std::ranges::max_element(values)
                                                           : mean_of(values));
    }
}

/// calculatenormal(P).
void normals(Run& run, const Step& step, std::span<const Operand> operands) {
    if (!is_flat(run, step, operands))
        calculate_normals(spans_of(run), run.lanes(), operands[1], operands[0]);
}

/// How far x changes over a vertex' footprint, as headers' filterwidth() has it: by du and dv. Without
/// footprints, as for shaders that are run alone, the differences to neighbouring vertices stand for it.
void filter_width(Run& run, const Operand& x, const Operand& out) {
    if (!run.context().footprints) return filter_widths(spans_of(run), run.lanes(), x, out);
    const Footprint& f = run.context().footprints->get();
    float* const by_v = run.scratch(1);
    derivative_u(spans_of(run), run.lanes(), 1, x, f.u, f.v, out);
    derivative_v(spans_of(run), run.lanes(), 1, x, f.u, f.v, {by_v, ~size_t{0}});
    for (size_t i = 0; i < run.lanes(); ++i)
        out.data[i] = std::abs(out.data[i] * f.du[i]) + std::abs(by_v[i] * f.dv[i]);
}

/// The ends of a range from x to x2, made wider about its middle.
void widen(size_t lanes, const Operand& x, const Operand& x2, const Operand& scale, const Operand& from,
           const Operand& to) {
    for (size_t i = 0; i < lanes; ++i) {
        const float a = Run::at(x, 0, i), b = Run::at(x2, 0, i);
        const float middle = (a + b) / 2, half = (b - a) / 2 * Run::at(scale, 0, i);
        from.data[i] = middle - half, to.data[i] = middle + half;
    }
}

/// edge, x [, x2] [, name, value, ...]; of the named ones, "width" counts, also as "swidth". A uniform x has
/// no width: the step is then a sharp one, as step() has it.
void filtered_step(Run& run, const Step& step, std::span<const Operand> operands) {
    const auto is_text = [&](size_t i) {
        return run.registers().reg(run.registers().register_of(step, i)).type.base == rsl::Base::String;
    };
    const size_t lanes = operands[0].lane_mask ? run.lanes() : kLanes;
    const bool is_range = step.count > 3 && !is_text(3);
    const Operand* scales = nullptr;
    for (size_t i = is_range ? 4 : 3; i + 1 < step.count; i += 2) {
        if (!is_text(i) || is_text(i + 1)) continue;
        const std::string& name = run.registers().text(run.registers().register_of(step, i));
        if (name == "width" || name == "swidth") scales = &operands[i + 1];
    }
    if (is_range && !scales)
        return filter_step_between(lanes, operands[1], operands[2], operands[3], operands[0]);
    if (is_range) {
        Operand from, to;
        from.data = run.scratch(2), to.data = from.data + run.lanes();
        from.lane_mask = to.lane_mask = ~size_t{0};
        widen(lanes, operands[2], operands[3], *scales, from, to);
        return filter_step_between(lanes, operands[1], from, to, operands[0]);
    }
    Operand widths;
    widths.data = run.scratch(1);
    widths.lane_mask = ~size_t{0};
    if (operands[2].lane_mask)
        filter_width(run, operands[2], widths);
    else
        std::fill_n(widths.data, run.lanes(), 0.0f);
    float scale = 1;
    if (scales && scales->lane_mask)
        for (size_t i = 0; i < run.lanes(); ++i) widths.data[i] *= scales->data[i];
    else if (scales)
        scale = scales->data[0];
    filter_step(lanes, operands[1], operands[2], widths, scale, operands[0]);
}

/// depth(P): 0 at the near clipping plane, 1 at the far one. RISpec's depth() takes a point in "current"
/// space, whose z is the distance along the view and not along the ray.
void depth(Run& run, const Step&, std::span<const Operand> operands) {
    const float near_clip = run.context().near_clip, far_clip = run.context().far_clip;
    const Operand &out = operands[0], &P = operands[1];
    for (size_t i = 0; i < plane_size(run, out); ++i) {
        const float z = Run::at(P, 2, i);
        out.data[i] = far_clip > near_clip ? (z - near_clip) / (far_clip - near_clip) : 0;
    }
}

constexpr ContextRow kNeighbourRows[] = {
    {Op::Du, differences},  {Op::Dv, differences},          {Op::Deriv, differences},
    {Op::Area, area},       {Op::CalculateNormal, normals}, {Op::FilterStep, filtered_step},
    {Op::GridMin, of_grid}, {Op::GridMax, of_grid},         {Op::GridAverage, of_grid},
    {Op::Depth, depth},
};

}  // namespace

ContextOp find_neighbour_op(Op op) {
    return context_op_in(kNeighbourRows, op);
}

}  // namespace trapeze::vm
