/// RISpec 4.1.2, Display, with the DisplayChannel that later RenderMans added.
#include <algorithm>
#include <cctype>
#include <string_view>

#include "pipeline/rib/requests/colorspaces.h"
#include "pipeline/rib/requests/request_table.h"
#include "pipeline/rib/state/recognised_names.h"

namespace trapeze::rib {
namespace {

constexpr size_t kLongestVariable = 200;  ///< characters; names become channels of files

/// Globals of surface shaders (RISpec, table 12.1) whose types nobody declares.
struct Global {
    std::string_view name;
    ValueType type;
};
constexpr Global kGlobals[] = {
    {"Ci", ValueType::Color},    {"Oi", ValueType::Color},    {"u", ValueType::Float},
    {"v", ValueType::Float},     {"du", ValueType::Float},    {"dv", ValueType::Float},
    {"dPdu", ValueType::Vector}, {"dPdv", ValueType::Vector}, {"I", ValueType::Vector},
    {"E", ValueType::Point},     {"time", ValueType::Float}};

/// A name that can become a channel of a picture file.
bool is_variable_name(std::string_view name) {
    const auto fits = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == ':'; };
    return !name.empty() && name.size() <= kLongestVariable && std::all_of(name.begin(), name.end(), fits);
}

/// A variable of one or three numbers, which files can hold; nothing for others.
std::optional<DisplayVariable> variable_of(const std::string& name, const Declaration& declaration) {
    constexpr ValueType kTypes[] = {ValueType::Float, ValueType::Integer, ValueType::Color,
                                    ValueType::Point, ValueType::Vector,  ValueType::Normal};
    const bool fits = std::find(std::begin(kTypes), std::end(kTypes), declaration.type) != std::end(kTypes);
    if (!fits || declaration.array_length != 1 || !is_variable_name(name)) return {};
    const bool is_integer = declaration.type == ValueType::Integer;  // a float of shaders
    return DisplayVariable{name, is_integer ? ValueType::Float : declaration.type};
}

/// Colour, alpha, depth, or ids: what no variable can hide.
bool is_of_the_picture(std::string_view mode) {
    for (const std::string_view channels : {"rgb", "a", "z"})
        if (mode.starts_with(channels)) mode.remove_prefix(channels.size());
    return mode.empty() || mode == "id";
}

/// What a mode names: "varying color foo", a DisplayChannel, or a variable whose type is known.
std::optional<DisplayVariable> variable_named(OptionContext& r, const std::string& mode) {
    if (is_of_the_picture(mode)) return {};
    if (const auto channel = r.state.scope().display_channels.find(mode);
        channel != r.state.scope().display_channels.end())
        return channel->second.variable;
    if (const auto declared = r.state.declarations().resolve(mode))
        return variable_of(declared->first, declared->second);
    for (const Global& global : kGlobals)
        if (global.name == mode) return DisplayVariable{mode, global.type};
    return {};
}

/// PRMan's "Ci,a" and the like: of a list of channels the picture's own, as RISpec writes them.
std::string picture_mode(OptionContext& r, const std::string& mode) {
    if (mode.find(',') == std::string::npos) return mode;
    std::string picture, rest;
    for (size_t begin = 0; begin <= mode.size();) {
        const size_t end = std::min(mode.find(',', begin), mode.size());
        std::string channel = mode.substr(begin, end - begin);
        begin = end + 1;
        std::erase(channel, ' ');
        if (channel == "Ci" || channel == "rgb" || channel == "rgba") channel = "rgb";
        const bool is_picture = channel == "rgb" || channel == "a" || channel == "z";
        if (is_picture && picture.find(channel) == std::string::npos) picture += channel;
        if (!is_picture) rest += (rest.empty() ? "" : ",") + channel;
    }
    if (!rest.empty() && !picture.empty())
        r.report.warn_once(
            "a file holds colour, alpha and depth, or one variable; " + in_quotes(rest) + " is left out",
            "display-channels " + rest);
    return picture.empty() ? mode : picture;
}

/// "+name" adds a display to those there are; another replaces them (RISpec 4.1.2).
void display(OptionContext& r, ArgumentCursor& c) {
    Display d;
    d.location = r.report.at();
    d.name = c.string("the name"), d.type = c.string("the type"), d.mode = c.string("the mode");
    d.mode = picture_mode(r, d.mode);
    d.parameters = r.parameters(c, Undeclared::Guess);
    for (const Parameter& value : d.parameters.values)
        if (!recognises_display_parameter(value.name))
            r.report.count_without_effect(' ' + in_quotes(value.name));
    colorspace_of(r.report, d.parameters);
    d.variable = variable_named(r, d.mode);
    if (const auto channel = r.state.scope().display_channels.find(d.mode);
        channel != r.state.scope().display_channels.end())
        for (const Parameter& parameter : channel->second.parameters.values)
            if (!d.parameters.find(parameter.name)) d.parameters.set(parameter);
    Options& o = changeable_options(r);
    const bool is_further = !d.name.empty() && d.name[0] == '+';
    if (is_further && d.parameters.string_or("source", "").find("lpe:") != std::string::npos) {
        r.report.warn_once(
            "there are no paths of light to choose from; " + in_quotes(d.name.substr(1)) + " is not written",
            "lpe " + d.name);
        return;
    }
    if (is_further) {
        d.name.erase(0, 1);
        o.displays.push_back(std::move(d));
    } else {
        o.displays.clear();
        o.displays.push_back(std::move(d));
    }
}

/// DisplayChannel declaration parameters: these are defaults of the displays that name the channel.
void display_channel(OptionContext& r, ArgumentCursor& c) {
    const std::string token = c.string("the channel");
    ParameterList parameters = r.parameters(c, Undeclared::Guess);
    changeable_options(r);
    auto variable = variable_named(r, token);
    if (!variable) {
        if (!is_of_the_picture(token))
            throw RequestError{in_quotes(token) + " is no float, color, point, vector or normal", {}};
        return;
    }
    const std::string channel = variable->name, source = parameters.string_or("source", "");
    // Others, "lpe:..." and the like, are not for names.
    if (is_variable_name(source) && source.find(':') == std::string::npos) variable->name = source;
    r.state.scope().display_channels[channel] = {*variable, std::move(parameters)};
}

constexpr RequestRow kDisplayRequests[] = {{"Display", display}, {"DisplayChannel", display_channel}};

}  // namespace

std::span<const RequestRow> display_requests() {
    return kDisplayRequests;
}

}  // namespace trapeze::rib
