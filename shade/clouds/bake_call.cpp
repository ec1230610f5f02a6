#include "shade/clouds/bake_call.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace trapeze {
namespace {

using vm::Operand;
using vm::Run;
using vm::Step;

/// Inputs of the call.
enum BakeInput : size_t { kBakeFile, kBakeChannels, kBakeP, kBakeN, kBakeNamed };

/// The names in a list "_area,_radiosity".
std::vector<std::string> names_in(const std::string& list) {
    constexpr const char* kBetween = ", \t";
    std::vector<std::string> names;
    for (size_t at = list.find_first_not_of(kBetween); at != std::string::npos;) {
        const size_t end = std::min(list.find_first_of(kBetween, at), list.size());
        names.push_back(list.substr(at, end - at));
        at = list.find_first_not_of(kBetween, end);
    }
    return names;
}

/// Of a flat quadrilateral half the product of the diagonals.
float area_of(const V3f& p00, const V3f& p10, const V3f& p01, const V3f& p11) {
    return 0.5f * (p11 - p00).cross(p01 - p10).length();
}

}  // namespace

BakeCall::BakeCall(Run& run, const Step& step, std::span<const Operand> operands)
    : step_(step),
      operands_(operands),
      P_(&operands[step.outputs + kBakeP]),
      N_(&operands[step.outputs + kBakeN]),
      mask_(run.masks().all() ? nullptr : run.masks().current()),
      file_(run.registers().text_input(step, kBakeFile)) {
    set_space(run, "world");
    for (size_t i = step.outputs + kBakeNamed; i + 2 < step.count; i += 3) take_named(run, i);
    choose_channels(run, run.registers().text_input(step, kBakeChannels));
}

/// A name, the type and a value: operands i, i + 1 and i + 2.
void BakeCall::take_named(Run& run, size_t i) {
    const vm::Registers& registers = run.registers();
    const std::string& name = registers.text(registers.register_of(step_, i));
    const std::string& type = registers.text(registers.register_of(step_, i + 1));
    const Operand& value = operands_[i + 2];
    if (type == "string") {
        const std::string& text = registers.text(registers.register_of(step_, i + 2));
        if (name == "coordsystem") set_space(run, text);
        if (name == "format") ascii_ = text == "ascii";
        if (name != "coordsystem" && name != "format") take_value(run, name, type, value);
        return;
    }
    if (type == "float" && name == "interpolate")
        interpolate_ = Run::at(value, 0, 0) != 0;
    else if (type == "float" && name == "radius")
        radius_ = &value;
    else if (type == "float" && name == "radiusscale")
        radius_scale_ = &value;
    else
        take_value(run, name, type, value);
}

void BakeCall::take_value(Run& run, const std::string& name, const std::string& type,
                          const Operand& operand) {
    ChannelType channel = ChannelType::Matrix;  // texts and arrays stay it, too
    channel_type_named(type, &channel);
    const bool known = std::ranges::any_of(values_, [&](const Value& v) { return v.channel.name == name; });
    if (channel != ChannelType::Matrix && is_channel_name(name) && !known && values_.size() < kMostChannels)
        values_.push_back({{name, channel}, &operand});
    else
        run.warn(step_, fmt::format("bake3d: \"{}\" is no channel of a point cloud and is left out", name),
                 "bake3d-channel " + name);
}

/// An empty list: all that values are given for.
void BakeCall::choose_channels(Run& run, const std::string& wanted) {
    const std::vector<std::string> names = names_in(wanted);
    if (names.empty()) return;
    std::vector<Value> chosen;
    for (const std::string& name : names) {
        const auto value =
            std::ranges::find_if(values_, [&](const Value& v) { return v.channel.name == name; });
        if (value != values_.end())
            chosen.push_back(*value);
        else
            run.warn(step_, fmt::format("bake3d: there is no value for the channel \"{}\"", name),
                     "bake3d-value " + name);
    }
    values_ = std::move(chosen);
}

void BakeCall::set_space(Run& run, const std::string& space) {
    to_space_.reset(), normals_to_space_.reset();
    if (!run.context().spaces || space == "current") return;
    to_space_ = run.context().spaces->matrix("current", space);
    if (to_space_)
        normals_to_space_ = M44f(M44d(*to_space_).inverse().transposed());
    else
        run.warn(step_, fmt::format("bake3d: there is no coordinate system \"{}\"", space),
                 "bake3d-space " + space);
}

bool BakeCall::runs(size_t lane) const {
    return !mask_ || mask_[lane] != 0;
}

V3f BakeCall::position(size_t lane) const {
    V3f p = vm::Run::triple_at(*P_, lane);
    if (to_space_) to_space_->multVecMatrix(V3f(p), p);
    return p;
}

/// The numbers of a vertex, of whose surface `area` is its own.
void BakeCall::take_numbers(size_t lane, float area, Numbers& numbers) const {
    const V3f p = position(lane);
    V3f n = vm::Run::triple_at(*N_, lane);
    if (normals_to_space_) normals_to_space_->multDirMatrix(V3f(n), n);
    const float scale = radius_scale_ ? Run::at(*radius_scale_, 0, lane) : 1;
    const float radius = radius_ ? Run::at(*radius_, 0, lane) : std::sqrt(area / std::numbers::pi_v<float>);
    numbers.assign({p.x, p.y, p.z, n.x, n.y, n.z, radius * scale});
    for (const Value& value : values_) {
        const ChannelType type = value.channel.type;
        if (type == ChannelType::Float) {
            numbers.push_back(Run::at(*value.operand, 0, lane));
            continue;
        }
        V3f v = vm::Run::triple_at(*value.operand, lane);
        if (to_space_ && type == ChannelType::Point) to_space_->multVecMatrix(V3f(v), v);
        if (to_space_ && type == ChannelType::Vector) to_space_->multDirMatrix(V3f(v), v);
        if (to_space_ && type == ChannelType::Normal) normals_to_space_->multDirMatrix(V3f(v), v);
        numbers.insert(numbers.end(), {v.x, v.y, v.z});
    }
}

/// Areas of a grid's micropolygons in the space of the file. `of_vertices` become a quarter of those around
/// each: together as large as the grid.
std::vector<float> BakeCall::areas_of(const vm::GridSpan& span, std::vector<float>& of_vertices) const {
    const GridShape& shape = span.shape;
    std::vector<float> areas;
    of_vertices.assign(static_cast<size_t>(shape.vertex_count()), 0);
    for (int v = 0; v < shape.nv; ++v)
        for (int u = 0; u < shape.nu; ++u) {
            const auto index = [&](int i, int j) {
                return static_cast<size_t>(shape.row_index(u + i, v + j));
            };
            const auto at = [&](int i, int j) { return position(span.first + index(i, j)); };
            const float area = area_of(at(0, 0), at(1, 0), at(0, 1), at(1, 1));
            areas.push_back(std::isfinite(area) ? area : 0);
            for (const size_t i : {index(0, 0), index(1, 0), index(0, 1), index(1, 1)})
                of_vertices[i] += areas.back() / 4;
        }
    return areas;
}

/// Adds a point, or counts it where it is none.
void BakeCall::add(Numbers numbers, BakedCall& baked) {
    if (!std::ranges::all_of(numbers, [](float x) { return std::isfinite(x); })) {
        ++baked.not_finite;
        return;
    }
    const V3f n = V3f(numbers[3], numbers[4], numbers[5]).normalized();
    for (int k = 0; k < 3; ++k) numbers[static_cast<size_t>(3 + k)] = n[k];
    baked.points.insert(baked.points.end(), numbers.begin(), numbers.end());
}

void BakeCall::bake_vertices(const vm::GridSpan& span, BakedCall& baked) const {
    std::vector<float> areas;
    areas_of(span, areas);
    Numbers numbers;
    for (size_t i = 0; i < areas.size(); ++i) {
        if (!runs(span.first + i)) continue;
        take_numbers(span.first + i, areas[i], numbers);
        add(numbers, baked);
    }
}

/// The means of the four corners.
void BakeCall::bake_micropolygons(const vm::GridSpan& span, BakedCall& baked) const {
    const GridShape& shape = span.shape;
    std::vector<float> of_vertices;
    const std::vector<float> areas = areas_of(span, of_vertices);
    Numbers corner, mean;
    for (int v = 0; v < shape.nv; ++v)
        for (int u = 0; u < shape.nu; ++u) {
            bool all = true;
            mean.clear();
            for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
                const size_t lane = span.first + static_cast<size_t>(shape.row_index(u + i, v + j));
                all = all && runs(lane);
                take_numbers(lane, areas[static_cast<size_t>(v * shape.nu + u)], corner);
                mean.resize(corner.size(), 0);
                for (size_t k = 0; k < corner.size(); ++k) mean[k] += corner[k] / 4;
            }
            if (all) add(mean, baked);
        }
}

BakedCall BakeCall::points_of(const vm::GridSpan& span) const {
    BakedCall baked;
    baked.file = file_;
    for (const Value& value : values_) baked.channels.push_back(value.channel);
    baked.ascii = ascii_;
    baked.at = step_.at;
    if (interpolate_)
        bake_micropolygons(span, baked);
    else
        bake_vertices(span, baked);
    return baked;
}

}  // namespace trapeze
