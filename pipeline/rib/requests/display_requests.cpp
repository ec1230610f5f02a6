/// RISpec 4.1.2, Display, with the DisplayChannel that later RenderMans added.
#include <algorithm>
#include <string_view>

#include "core/scene/aov.h"
#include "pipeline/rib/requests/colorspaces.h"
#include "pipeline/rib/requests/request_table.h"
#include "pipeline/rib/state/recognised_names.h"

namespace trapeze::rib {
namespace {

/// Globals of surface shaders (RISpec, table 12.1) whose types nobody declares.
struct Global {
    std::string_view name;
    ValueType type;
};

/// Cs, Os, P, N, Ng, s and t are not here: they are predeclared, as primitives may have them.
constexpr Global kGlobals[] = {
    {"Ci", ValueType::Color},    {"Oi", ValueType::Color},    {"u", ValueType::Float},
    {"v", ValueType::Float},     {"du", ValueType::Float},    {"dv", ValueType::Float},
    {"dPdu", ValueType::Vector}, {"dPdv", ValueType::Vector}, {"I", ValueType::Vector},
    {"E", ValueType::Point},     {"time", ValueType::Float}};

/// A variable of one or three numbers, which files can hold; nothing for others.
std::optional<DisplayVariable> variable_of(const std::string& name, const Declaration& declaration) {
    constexpr ValueType kTypes[] = {ValueType::Float, ValueType::Integer, ValueType::Color,
                                    ValueType::Point, ValueType::Vector,  ValueType::Normal};
    const bool fits = std::find(std::begin(kTypes), std::end(kTypes), declaration.type) != std::end(kTypes);
    if (!fits || declaration.array_length != 1 || !can_name_channels(name)) return {};
    const bool is_integer = declaration.type == ValueType::Integer;  // a float of shaders
    return DisplayVariable{name, is_integer ? ValueType::Float : declaration.type};
}

/// Colour, alpha, depth, or ids: what no variable can hide.
bool is_of_the_picture(std::string_view mode) {
    for (const std::string_view channels : {"rgb", "a", "z"})
        if (mode.starts_with(channels)) mode.remove_prefix(channels.size());
    return mode.empty() || mode == "id" || mode.starts_with("crypto_");
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

/// The modes of a Display's mode: one, or PRMan's "Ci,a,albedo", a list of channels. The picture's own among
/// these are one mode, the first, as RISpec writes it. "Ci" is another name of "rgb": the picture's, after
/// exposure and imager.
std::vector<std::string> modes_of(const std::string& mode) {
    if (mode.find(',') == std::string::npos) return {mode == "Ci" ? "rgb" : mode};
    std::string picture;
    std::vector<std::string> modes;
    for (size_t begin = 0; begin <= mode.size();) {
        const size_t end = std::min(mode.find(',', begin), mode.size());
        std::string channel = mode.substr(begin, end - begin);
        begin = end + 1;
        channel.erase(0, channel.find_first_not_of(' '));
        channel.erase(channel.find_last_not_of(' ') + 1);
        if (channel == "rgba") picture += "rgba";
        if (channel == "Ci" || channel == "rgb") channel = "rgb";
        const bool is_picture = channel == "rgba" || channel == "rgb" || channel == "a" || channel == "z";
        if (is_picture && picture.find(channel) == std::string::npos) picture += channel;
        if (!is_picture && !channel.empty()) modes.push_back(channel);
    }
    // Channels stand in this order, whatever the list's.
    std::string in_order;
    for (const char* channel : {"rgb", "a", "z"})
        if (picture.find(channel) != std::string::npos) in_order += channel;
    if (!in_order.empty() || modes.empty()) modes.insert(modes.begin(), in_order);
    return modes;
}

/// DisplayChannel "filter" of later RenderMans, as Displays may have it too: one sample of a pixel stands for
/// it.
VariableFilter variable_filter(OptionContext& r, const ParameterList& parameters) {
    constexpr std::pair<std::string_view, VariableFilter> kFilters[] = {{"min", VariableFilter::Min},
                                                                        {"max", VariableFilter::Max},
                                                                        {"zmin", VariableFilter::Nearest},
                                                                        {"zmax", VariableFilter::Farthest}};
    const std::string name = parameters.string_or("filter", "");
    for (const auto& [known, filter] : kFilters)
        if (name == known) return filter;
    if (!name.empty() && name != "default" && name != "importance")
        r.report.warn_once("filter " + in_quotes(name) +
                               " of a display is none of min, max, zmin and zmax; the picture's is used",
                           "display-filter " + name);
    return VariableFilter::Picture;
}

/// A display of one mode, whose variable and whose channel's parameters it gets. What the Display says itself
/// wins over what its channel says.
Display with_mode(OptionContext& r, Display display, const std::string& mode) {
    display.mode = mode;
    display.variable = variable_named(r, mode);
    const auto& channels = r.state.scope().display_channels;
    if (const auto channel = channels.find(mode); channel != channels.end()) {
        display.layer = mode;
        for (const Parameter& parameter : channel->second.parameters.values)
            if (!display.parameters.find(parameter.name)) display.parameters.set(parameter);
    }
    const VariableFilter filter = variable_filter(r, display.parameters);
    if (display.variable)
        display.variable->filter = filter;
    else if (filter != VariableFilter::Picture)
        r.report.warn_once("a filter of a display is for variables; " + in_quotes(mode) + " of " +
                               in_quotes(display.name) + " has the picture's",
                           "display-filter-mode " + display.name + ' ' + mode);
    return display;
}

/// Whether the display shows some of the paths that light takes, which are not told apart here.
bool shows_paths(OptionContext& r, const Display& display) {
    if (display.parameters.string_or("source", "").find("lpe:") == std::string::npos) return false;
    r.report.warn_once("there are no paths of light to choose from; " + in_quotes(display.mode) +
                           " is left out of " + in_quotes(display.name),
                       "lpe " + display.name);
    return true;
}

/// "+name" adds a display to those there are; another replaces them (RISpec 4.1.2). A list of channels makes
/// a display of each that is not of the picture itself, all of one file.
void display(OptionContext& r, ArgumentCursor& c) {
    Display common;
    common.location = r.report.at();
    common.name = c.string("the name"), common.type = c.string("the type");
    const std::vector<std::string> modes = modes_of(c.string("the mode"));
    common.parameters = r.parameters(c, Undeclared::Guess);
    for (const Parameter& value : common.parameters.values)
        if (!recognises_display_parameter(value.name))
            r.report.count_without_effect(' ' + in_quotes(value.name));
    colorspace_of(r.report, common.parameters);
    bool is_further = !common.name.empty() && common.name[0] == '+';
    if (is_further) common.name.erase(0, 1);
    Options& o = changeable_options(r);
    for (const std::string& mode : modes) {
        Display one = with_mode(r, common, mode);
        if (is_further && shows_paths(r, one)) continue;
        if (!is_further) o.displays.clear();
        o.displays.push_back(std::move(one));
        is_further = true;
    }
}

/// The variable that a "source" names, with its type before it or without: "normal Nn", "Ci".
std::string source_variable(const std::string& source) {
    std::string name = source.substr(source.find_last_of(' ') + 1);
    return name == "Nn" ? "N" : name;  // as PRMan calls it where it is of unit length
}

/// DisplayChannel declaration parameters: these are defaults of the displays that name the channel. "source"
/// names another variable of the shader, whose values the channel shows under its own name.
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
    const std::string channel = variable->name, source = source_variable(parameters.string_or("source", ""));
    // Others, "lpe:..." and the like, are not for names.
    if (can_name_channels(source) && source.find(':') == std::string::npos) variable->name = source;
    r.state.scope().display_channels[channel] = {*variable, std::move(parameters)};
}

constexpr RequestRow kDisplayRequests[] = {{"Display", display}, {"DisplayChannel", display_channel}};

}  // namespace

std::span<const RequestRow> display_requests() {
    return kDisplayRequests;
}

}  // namespace trapeze::rib
