#include "pipeline/cli/commands/compliance_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "pipeline/cli/commands/compliance_notes.h"
#include "pipeline/rib/read_rib.h"
#include "pipeline/rib/reader/known_requests.h"
#include "pipeline/rib/state/recognised_names.h"
#include "pipeline/rib/syntax/arguments.h"
#include "shade/rsl/analysis/builtins.h"
#include "shade/shaders/standard_shaders.h"

namespace trapeze {
namespace {

/// A scene and the requests in it, archives included.
struct SceneRequests {
    std::string name;
    std::set<std::string> requests;
};

/// The requests that a scene's file has, read without its geometry.
SceneRequests requests_of(const std::string& path) {
    const std::filesystem::path file(path);
    SceneRequests scene{(file.parent_path().filename() / file.filename()).string(), {}};
    Diagnostics diagnostics([](const Diagnostic&) {});
    ReadOptions options;
    options.keep_geometry = false;
    const std::vector<std::string> files{path};
    const ReadSummary summary = read_rib(files, options, diagnostics, [](Scene&&) {});
    for (const auto& [request, count] : summary.requests) scene.requests.insert(request);
    return scene;
}

std::string letters_of(std::string_view name) {
    std::string letters;
    for (const char c : name)
        if (std::isalpha(static_cast<unsigned char>(c)))
            letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return letters;
}

/// One that is named like the request, else the one with the fewest requests.
std::string shown_by(const std::string& request, const std::vector<SceneRequests>& scenes) {
    const SceneRequests* best = nullptr;
    const auto is_named = [&](const SceneRequests& scene) {
        return letters_of(scene.name.substr(scene.name.find('/'))).find(letters_of(request)) !=
               std::string::npos;
    };
    for (const SceneRequests& scene : scenes) {
        if (!scene.requests.contains(request)) continue;
        const auto rank = [&](const SceneRequests& s) {
            return std::tuple(!is_named(s), s.requests.size(), s.name);
        };
        if (!best || rank(scene) < rank(*best)) best = &scene;
    }
    return best ? best->name : "";
}

template <class Notes>
std::string note_of(const Notes& notes, std::string_view name) {
    const auto found = std::ranges::find_if(notes, [&](const auto& note) { return name == note.request; });
    return found == notes.end() ? "" : found->limits;
}

std::string request_table(std::span<const std::string> names, const std::vector<SceneRequests>& scenes) {
    std::string text = "| Request | Standing | Limits | Shown by |\n|---|---|---|---|\n";
    for (const std::string& name : names) {
        const rib::Request* request = rib::find_request(name);
        const bool done = request && request->group != rib::RequestGroup::Unsupported;
        const std::string note = note_of(request_notes(), name);
        text += fmt::format("| {} | {} | {} | {} |\n", name,
                            !done          ? "skipped, with a warning"
                            : note.empty() ? "supported"
                                           : "with limits",
                            note, shown_by(name, scenes));
    }
    return text;
}

std::string listed_names(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text + ".\n";
}

std::string headers() {
    std::string text = "| Header | Has | Lacks |\n|---|---|---|\n";
    for (const HeaderNote& note : header_notes())
        text += fmt::format("| {} | {} | {} |\n", note.name, note.has, note.lacks);
    return text;
}

/// What a function lacks. Those of later renderers compile, so that their shaders do, and are not there.
std::string limits_of(const std::string& name) {
    if (rsl::builtins_named(name).front().op == rsl::Op::Unavailable)
        return fmt::format("not there: a call warns, and gives {}", name == "rayhittest" ? "1e30" : "0");
    return note_of(function_notes(), name);
}

std::string functions() {
    std::map<std::string, int> overloads;
    for (const rsl::Builtin& builtin : rsl::builtins()) ++overloads[std::string(builtin.name)];
    std::string text = "| Function | Overloads | Limits |\n|---|---|---|\n";
    for (const auto& [name, count] : overloads)
        text += fmt::format("| {} | {} | {} |\n", name, count, limits_of(name));
    return text;
}

/// Headers without a note, and names that are said to be in a header and are not.
void add_wrong_header_notes(std::vector<std::string>& wrong) {
    for (const std::string_view name : standard_header_names())
        if (std::ranges::none_of(header_notes(), [&](const HeaderNote& note) { return note.name == name; }))
            wrong.emplace_back(name);
    for (const HeaderNote& note : header_notes()) {
        const std::string_view text = standard_header(note.name);
        std::istringstream names(note.has);
        for (std::string name; std::getline(names >> std::ws, name, ',');)
            if (text.find(name) == std::string_view::npos)
                wrong.push_back(std::string(note.name) + ": " + name);
    }
}

}  // namespace

std::string compliance_page(const std::vector<std::string>& paths) {
    std::vector<SceneRequests> scenes;
    for (const std::string& path : paths) scenes.push_back(requests_of(path));
    std::vector<std::string> rispec(rispec_requests().begin(), rispec_requests().end()), later;
    std::sort(rispec.begin(), rispec.end());
    const std::vector<std::string> all = rib::request_names();
    std::set_difference(all.begin(), all.end(), rispec.begin(), rispec.end(), std::back_inserter(later));

    std::string text =
        "# Compliance with the RenderMan Interface 3.2\n\n"
        "Written by `trapeze compliance` from the program's own tables; a test holds it to them. The scenes "
        "are in scenes/tiny, where each has a reference picture in tests/references, or in "
        "scenes/gallery.\n\n"
        "Required features (RISpec 1.1) are complete: the graphics state, perspective and orthographic "
        "views, depth-based hidden surfaces, filtering, exposure, quantisation, files of colour, alpha and "
        "depth at any size, all geometric primitives with all their variables, programmable shading, "
        "texture, environment and shadow maps, the fifteen standard shaders. The painter's hider is the one "
        "exception: hidden is used in its place, with a warning.\n\n"
        "## Optional capabilities\n\n";
    for (const Capability& c : capabilities())
        text += fmt::format("**{}**: {}. {}\n\n", c.name, c.standing, c.text);
    text +=
        "**C binding**: supported. Every call of RISpec 3.2, varargs and V forms (pipeline/ri/ri.h), as a "
        "static library. Filter functions are RISpec's own.\n\n";
    text += "## Requests of RISpec 3.2\n\n" + request_table(rispec, scenes);
    text += "\n## Requests of later RenderMans\n\n" + request_table(later, scenes);
    const rib::RecognisedNames settings = rib::recognised_names();
    text +=
        "\n## Settings with an effect\n\nAll others are kept for shaders to read, and `trapeze check` "
        "lists them.\n\n";
    text +=
        "- Option: " + listed_names(settings.options) + "- Attribute: " + listed_names(settings.attributes);
    text += "- Hider: " + listed_names(settings.hider) + "- Display: " + listed_names(settings.display);
    text += "\n## Settings that need no effect\n\nThey ask for what is so in any case.\n\n";
    for (const rib::UnneededAttribute& s : rib::unneeded_attributes())
        text += fmt::format("- Attribute {} {}: {}.\n", s.category, s.name, s.why);
    const auto names = standard_shader_names();
    text += "\n## Standard shaders\n\n" + listed_names({names.begin(), names.end()});
    text +=
        "\n## Headers for shaders\n\nFiles that shaders include by custom, written anew from what is published of "
        "their functions; a file of the same name beside a scene or on the shaders' search path comes first.\n\n";
    text += headers();
    text +=
        "\n## Built-in functions of the shading language\n\nAll statements are supported.\n\n" + functions();
    return text;
}

std::vector<std::string> notes_without_request() {
    std::vector<std::string> wrong;
    for (const RequestNote& note : request_notes())
        if (!rib::find_request(note.request)) wrong.emplace_back(note.request);
    for (const RequestNote& note : function_notes())
        if (rsl::builtins_named(note.request).empty()) wrong.emplace_back(note.request);
    for (const char* request : rispec_requests())
        if (!rib::find_request(request)) wrong.emplace_back(request);
    add_wrong_header_notes(wrong);
    return wrong;
}

}  // namespace trapeze
