#include "composite/displays/pixel_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "composite/displays/small_letters.h"
#include "core/colors/transfer.h"

namespace trapeze {
namespace {

/// A parameter that has at least four floats; else null.
const Parameter* four_floats(const ParameterList& list, std::string_view name) {
    const Parameter* parameter = list.find(name);
    return parameter && parameter->floats.size() >= 4 ? parameter : nullptr;
}

/// What the format cannot hold becomes 8 bits. OpenEXR has no use for it.
void fit_to_format(Quantization& quantization, FileFormat format) {
    const bool takes_floats = format == FileFormat::Tiff || format == FileFormat::OpenExr;
    const bool takes_16_bits = takes_floats || format == FileFormat::Png;
    if (quantization.to_float() ? !takes_floats : quantization.has_16_bits() && !takes_16_bits)
        quantization = Quantization{};
}

/// Chooses whether colours are encoded by the sRGB curve, and whether a view comes in its place. What a
/// display itself says comes before both.
void choose_encoding(const Display& display, const Options& options, DisplayPlan& plan) {
    if (plan.format == FileFormat::OpenExr || plan.quantization.to_float()) return;
    if (!plan.rgb && !plan.aov_is_color) return;
    const auto own = transfer_named(display.parameters.string_or("colorspace", ""));
    const Transfer transfer = own.value_or(transfer_of(options));
    plan.srgb = transfer == Transfer::Srgb || (transfer == Transfer::Auto && options.exposure_gamma == 1 &&
                                               !plan.quantization.has_16_bits());
    plan.viewed = !own;
}

void tell(const Display& display, Diagnostics& diagnostics, const DisplayPlan& plan,
          const std::string& what) {
    diagnostics.warning(display.location, fmt::format("\"{}\": {}", plan.path, what),
                        fmt::format("display-pixels {} {}", plan.path, what));
}

/// "quantize" is an array; with fewer numbers, or an empty range, it says nothing.
void check_own(const Display& display, Diagnostics& diagnostics, const DisplayPlan& plan) {
    if (!display.parameters.find("quantize") || own_quantization(display)) return;
    const Parameter* four = four_floats(display.parameters, "quantize");
    tell(display, diagnostics, plan,
         four ? fmt::format("\"quantize\" has a least value of {} above its largest, {}; it is ignored",
                            four->floats[2], four->floats[3])
              : "\"quantize\" wants four numbers, zero, one, min and max; it is ignored");
}

/// "type" or OpenEXR's own name for it, in small letters; empty where it is not known.
std::string pixel_type(const Display& display, Diagnostics& diagnostics, const DisplayPlan& plan) {
    const ParameterList& list = display.parameters;
    const std::string type = in_small_letters(list.string_or("exrpixeltype", list.string_or("type", "")));
    if (type.empty() || type == "float" || type == "half") return type;
    tell(display, diagnostics, plan,
         fmt::format("type \"{}\" is neither \"half\" nor \"float\"; it is ignored", type));
    return {};
}

}  // namespace

const Parameter* own_quantization(const Display& display) {
    const Parameter* own = four_floats(display.parameters, "quantize");
    return own && own->floats[2] <= own->floats[3] ? own : nullptr;
}

const Parameter* given_quantization(const Options& options, std::string_view type) {
    return four_floats(options.quantize, type);
}

void choose_pixel_type(const Display& display, const Options& options, Diagnostics& diagnostics,
                       DisplayPlan& plan) {
    check_own(display, diagnostics, plan);
    const Parameter* own = own_quantization(display);
    const bool color = plan.rgb || plan.alpha || plan.aov_is_color;
    const Parameter* given = plan.aov ? given_quantization(options, plan.aov->name) : nullptr;
    if (!given && plan.aov && !plan.aov_is_color) plan.quantization.make_float();
    if (!given && (!plan.aov || plan.aov_is_color)) given = given_quantization(options, color ? "rgba" : "z");
    if (given) plan.quantization = {given->floats[0], given->floats[1], given->floats[2], given->floats[3]};
    if (own) {
        plan.quantization.zero = own->floats[0], plan.quantization.one = own->floats[1];
        plan.quantization.min = own->floats[2], plan.quantization.max = own->floats[3];
    }
    plan.quantization.dither = display.parameters.float_or("dither", plan.quantization.dither);
    if (!color && !plan.aov) plan.quantization.make_float();  // depth
    plan.float_pixels =
        own && std::all_of(own->floats.begin(), own->floats.begin() + 4, [](float v) { return v == 0; });
    const std::string type = pixel_type(display, diagnostics, plan);
    if (type == "float") plan.float_pixels = true, plan.quantization.make_float();
    if (type == "half") plan.float_pixels = false;
    if ((plan.aov && !plan.aov_is_color) || (plan.deep && type != "half")) plan.float_pixels = true;
    fit_to_format(plan.quantization, plan.format);
    choose_encoding(display, options, plan);
}

}  // namespace trapeze
