#include "pipeline/rib/ri_values.h"

#include <string_view>

namespace trapeze::rib {
namespace {

struct RiValue {
    std::string_view value, request;
    double before[2] = {0, 0};  ///< arguments before the value's
    int before_count = 0;
    double after = 0;
    bool has_after = false;
};

/// Sizes and aspects below 0 leave Format's as they are.
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

Argument number(double value, SourceLocation at) {
    Argument argument;
    argument.at = at, argument.number = value;
    return argument;
}

}  // namespace

bool execute_ri_value(Reader& reader, const Parameter& value) {
    for (const RiValue& known : kValues) {
        if (known.value != value.name) continue;
        RequestText text;
        text.at = reader.at();
        for (int i = 0; i < known.before_count; ++i)
            text.arguments.push_back(number(known.before[i], text.at));
        Argument& argument = text.arguments.emplace_back();
        argument.at = text.at;
        argument.kind = value.is_string() ? Argument::Kind::String : Argument::Kind::Array;
        argument.floats = value.floats, argument.strings = value.strings;
        if (known.has_after) text.arguments.push_back(number(known.after, text.at));
        ArgumentCursor cursor(text);
        find_request(known.request)->handler(reader, cursor);
        return true;
    }
    return false;
}

}  // namespace trapeze::rib
