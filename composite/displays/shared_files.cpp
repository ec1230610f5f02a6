#include "composite/displays/shared_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace trapeze {
namespace {

/// Compressions of OpenEXR that change floats, or halves of channels that they take for colours.
constexpr std::string_view kLossy[] = {"pxr24", "b44", "b44a", "dwaa", "dwab"};

/// Names that mean one file are equal here.
std::string file_key(const std::string& path) {
    return std::filesystem::path(path).lexically_normal().string();
}

SharedFile* find_file(std::vector<SharedFile>& files, const std::string& path) {
    const auto found = std::find_if(files.begin(), files.end(), [&](const SharedFile& file) {
        return file_key(file.plans.front().path) == file_key(path);
    });
    return found == files.end() ? nullptr : &*found;
}

/// Whether the display's channels can be layers of the file.
bool can_share(const SharedFile& file, const DisplayPlan& plan) {
    if (plan.deep || file.plans.front().deep || plan.format != FileFormat::OpenExr ||
        file.plans.front().format != FileFormat::OpenExr)
        return false;
    const std::vector<std::string> wanted = channel_names(plan, true);
    return std::none_of(file.plans.begin(), file.plans.end(), [&](const DisplayPlan& other) {
        const std::vector<std::string> names = channel_names(other, true);
        return std::find_first_of(names.begin(), names.end(), wanted.begin(), wanted.end()) != names.end();
    });
}

/// Lets the file have what a further display asks for of the file as a whole, where none before it did.
void share_settings(const Display& display, DisplayPlan& file, const DisplayPlan& further,
                    Diagnostics& diagnostics) {
    if (file.compression.empty()) file.compression = further.compression;
    if (!further.compression.empty() && further.compression != file.compression)
        diagnostics.warning(display.location,
                            fmt::format("\"{}\" has one compression, \"{}\"; \"{}\" is not used", file.path,
                                        file.compression, further.compression),
                            "display-compressions " + file.path);
    if (file.tile_side == 0) file.tile_side = further.tile_side;
    for (const Parameter& attribute : further.attributes)
        if (std::none_of(file.attributes.begin(), file.attributes.end(),
                         [&](const Parameter& known) { return known.name == attribute.name; }))
            file.attributes.push_back(attribute);
}

/// The name for a variable N whose file "a.exr" another display of the picture has: "a.N.exr".
std::string beside(const DisplayPlan& plan, const Display& display, std::vector<SharedFile>& files) {
    const std::filesystem::path path(plan.path);
    const std::string shown = plan.aov ? plan.aov->name : display.mode.empty() ? "rgba" : display.mode;
    std::string apart;
    for (int number = 1; apart.empty() || find_file(files, apart); ++number)
        apart = (path.parent_path() / fmt::format("{}.{}{}{}", path.stem().string(), shown,
                                                  number > 1 ? std::to_string(number) : "",
                                                  path.extension().string()))
                    .string();
    return apart;
}

/// Adds a display to the file that it names, or as a file of its own.
void add_display(const Display& display, DisplayPlan plan, const Access& access, Diagnostics& diagnostics,
                 std::vector<SharedFile>& files) {
    if (SharedFile* const file = find_file(files, plan.path); file && can_share(*file, plan)) {
        share_settings(display, file->plans.front(), plan, diagnostics);
        file->plans.push_back(std::move(plan));
        return;
    }
    OutputPlace place = place_to_write(plan.path, access, display.location, diagnostics);
    // Pictures that were meant for folders of other machines all go into the working folder: of several with
    // the same name there only the first can have it.
    if (place.name == plan.path || !find_file(files, place.name))
        plan.path = place.name;
    else
        place.problem =
            fmt::format("there is no folder \"{}\"", std::filesystem::path(plan.path).parent_path().string());
    if (find_file(files, plan.path)) {
        const std::string apart = beside(plan, display, files);
        diagnostics.warning(
            display.location,
            fmt::format("\"{}\" is another display's; \"{}\" is written beside it", plan.path, apart),
            "display-twice " + apart);
        plan.path = apart;
        const Access::Writing writing = access.may_write(apart);
        place = {apart, writing.path, writing.problem};
    }
    files.push_back({{std::move(plan)}, std::move(place), display.location});
}

/// Ids are numbers of which each bit counts.
void refuse_lossy_compression(SharedFile& file, Diagnostics& diagnostics) {
    DisplayPlan& first = file.plans.front();
    const bool loses = std::find(std::begin(kLossy), std::end(kLossy), first.compression) != std::end(kLossy);
    if (!loses || std::none_of(file.plans.begin(), file.plans.end(),
                               [](const DisplayPlan& p) { return p.id || p.matte; }))
        return;
    diagnostics.warning(file.location,
                        fmt::format("\"{}\" has ids, which the compression \"{}\" would lose; the usual one, "
                                    "zip, is used",
                                    first.path, first.compression),
                        "display-lossy " + first.path);
    first.compression.clear();
}

}  // namespace

std::vector<SharedFile> files_of_displays(const Options& options, const Access& access,
                                          Diagnostics& diagnostics) {
    const AovLayout layout = aov_layout(options);
    std::vector<SharedFile> files;
    for (const Display& display : options.displays)
        if (auto plan = plan_display(display, options, layout, diagnostics))
            add_display(display, std::move(*plan), access, diagnostics, files);
    for (SharedFile& file : files) refuse_lossy_compression(file, diagnostics);
    return files;
}

}  // namespace trapeze
