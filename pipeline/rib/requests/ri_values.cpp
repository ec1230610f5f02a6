#include "pipeline/rib/requests/ri_values.h"

#include <cmath>
#include <string_view>
#include <type_traits>

#include "pipeline/rib/reader/known_requests.h"

namespace trapeze::rib {
namespace {

/// An option or attribute of Ri ("Format", "Shutter"...) given as a value: its name, the request that sets
/// it, and the arguments that complete that request.
struct RiValue {
    std::string_view value, request;
    double before[2] = {0, 0};  ///< arguments that stand before the value in the request
    int before_count = 0;       ///< how many of `before` the request has
    double after = 0;           ///< an argument that stands behind the value
    bool has_after = false;
};

/// Requests that set each value. Sizes and aspects below 0 leave what Format has set.
constexpr RiValue kValues[] = {
    {"FormatResolution", "Format", {}, 0, -1, true},
    {"FormatPixelAspectRatio", "Format", {-1, -1}, 2, 0, false},
    {"FrameAspectRatio", "FrameAspectRatio"},
    {"ScreenWindow", "ScreenWindow"},
    {"CropWindow", "CropWindow"},
    {"Clipping", "Clipping"},
    {"Shutter", "Shutter"},
    {"DepthOfField", "DepthOfField"},
    {"PixelVariance", "PixelVariance"},
    {"RelativeDetail", "RelativeDetail"},
    {"ShadingRate", "ShadingRate"},
    {"Sides", "Sides"},
    {"Matte", "Matte"},
    {"Orientation", "Orientation"},
    {"DetailRange", "DetailRange"},
};

/// Arguments of a request that stands in no file: their location is the value's.
Argument text_argument(const std::string& value, SourceLocation at) {
    Argument argument;
    argument.kind = Argument::Kind::String;
    argument.at = at, argument.strings.push_back(value);
    return argument;
}

/// A number without brackets, as files write it.
Argument number(double value, SourceLocation at) {
    Argument argument;
    argument.at = at, argument.number = value;
    return argument;
}

/// Calls the handler of a request, which is one of an option or an attribute. An OptionContext is a
/// StateContext too, so handlers of both families can be called with it; no value of the table belongs to
/// another family.
void execute(std::string_view request, OptionContext& context, ArgumentCursor& cursor) {
    std::visit(
        [&](auto handler) {
            if constexpr (std::is_invocable_v<decltype(handler), OptionContext&, ArgumentCursor&>)
                handler(context, cursor);
        },
        find_request(request)->handler);
}

/// Sets PixelFilterName or PixelFilterWidth, each of which is half of a PixelFilter request: the other half
/// stays. False for another name. A value of the wrong kind or length is not taken, and is then counted as
/// one without effect.
bool execute_filter(OptionContext& context, const Parameter& value) {
    PixelFilter filter = context.state.options().filter;
    if (value.name == "PixelFilterName" && value.strings.size() == 1)
        filter.name = value.strings[0];
    else if (value.name == "PixelFilterWidth" && value.floats.size() == 2)
        filter.width_x = value.floats[0], filter.width_y = value.floats[1];
    else
        return false;
    RequestText text;
    text.arguments = {text_argument(filter.name, context.report.at()),
                      number(filter.width_x, context.report.at()),
                      number(filter.width_y, context.report.at())};
    ArgumentCursor cursor(text);
    execute("PixelFilter", context, cursor);
    return true;
}

/// Sets "Frame", the number that "Frame" of conditions and file names shows. False for another name.
bool set_frame(OptionContext& context, const Parameter& value) {
    if (value.name != "Frame" || value.floats.size() != 1 || !(std::abs(value.floats[0]) < 1e9f))
        return false;
    context.state.options().frame = static_cast<int>(value.floats[0]);
    return true;
}

}  // namespace

/// The value becomes the arguments of a request, whose handler does what it always does, checks and messages
/// included.
bool execute_ri_value(OptionContext& context, const Parameter& value) {
    if (execute_filter(context, value) || set_frame(context, value)) return true;
    for (const RiValue& known : kValues) {
        if (known.value != value.name) continue;
        RequestText text;
        text.at = context.report.at();
        for (int i = 0; i < known.before_count; ++i)
            text.arguments.push_back(number(known.before[i], text.at));
        Argument& argument = text.arguments.emplace_back();
        argument.at = text.at;
        argument.kind = value.is_string() ? Argument::Kind::String : Argument::Kind::Array;
        argument.floats = value.floats, argument.strings = value.strings;
        if (known.has_after) text.arguments.push_back(number(known.after, text.at));
        ArgumentCursor cursor(text);
        execute(known.request, context, cursor);
        return true;
    }
    return false;
}

}  // namespace trapeze::rib
