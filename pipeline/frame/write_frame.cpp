#include "pipeline/frame/write_frame.h"

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>

#include "composite/displays/write_displays.h"
#include "pipeline/frame/cost/stopwatch.h"
#include "pipeline/frame/json_text.h"
#include "pipeline/frame/version.h"

namespace trapeze {
namespace {

/// The date that SOURCE_DATE_EPOCH asks for (reproducible-builds.org), in seconds since 1970; nothing when it
/// is not set to a number.
std::optional<std::time_t> date_of_environment() {
    const char* const text = std::getenv("SOURCE_DATE_EPOCH");
    if (!text) return {};
    std::time_t seconds = 0;
    const auto [end, problem] = std::from_chars(text, text + std::strlen(text), seconds);
    return problem == std::errc() && *end == 0 ? std::optional(seconds) : std::nullopt;
}

/// "2026:01:31 23:59:59", UTC; empty for what no calendar has.
std::string date_text(std::time_t seconds) {
    std::tm parts{};
    char text[32];
    if (!gmtime_r(&seconds, &parts) || parts.tm_year + 1900 > 9999) return {};
    return {text, std::strftime(text, sizeof text, "%Y:%m:%d %H:%M:%S", &parts)};
}

/// The files' names without folders, which are nobody else's business, in one text.
std::string names_of(const std::vector<std::string>& files) {
    std::string names;
    for (const std::string& file : files)
        if (file != "-")
            names += (names.empty() ? "" : " ") + std::filesystem::path(file).filename().string();
    return names;
}

/// What a picture's header says of its render: the most telling counts, and seconds.
std::string stats_text(const FrameStats& stats) {
    return json_text({{"primitives", stats.tessellate.primitives},
                      {"micropolygons", stats.tessellate.micropolygons},
                      {"shaded_vertices", stats.shade.shaded_vertices},
                      {"samples", stats.samples},
                      {"predicate_tests", stats.sample.predicate_tests},
                      {"nodes_visited", stats.sample.nodes_visited},
                      {"peak_rss", peak_resident_bytes()},
                      {"threads", stats.threads},
                      {"simd_target", stats.simd_target},
                      {"seconds",
                       {{"tessellate", stats.seconds.tessellate},
                        {"shade", stats.seconds.shade},
                        {"build", stats.seconds.build},
                        {"trace", stats.seconds.trace},
                        {"composite", stats.seconds.composite}}}},
                     -1);
}

OutputInfo info_of(const FrameStats& stats, const RenderContext& context,
                   const std::vector<std::string>& scene_files) {
    OutputInfo info;
    info.software = std::string("Trapeze ") + kVersion;
    info.metadata = {
        {"sampler", stats.sampler},
        {"samples", std::to_string(context.samples_x) + "x" + std::to_string(context.samples_y)}};
    if (stats.tile) info.metadata.emplace_back("tile", name_of(*stats.tile));
    const auto date = date_of_environment();
    if (!date) info.metadata.emplace_back("renderTime", std::to_string(stats.seconds.total));
    if (!date) info.stats = stats_text(stats);
    info.date = date_text(date.value_or(std::time(nullptr)));
    if (context.scene->options.frame != 0) info.frame = context.scene->options.frame;
    info.scene = names_of(scene_files);
    return info;
}

}  // namespace

bool write_frame(FrameResult& frame, const RenderContext& context, const Access& access,
                 const std::vector<std::string>& scene_files, KeptPictures* kept) {
    Stopwatch watch;
    FrameStats& stats = frame.stats;
    OutputInfo info = info_of(stats, context, scene_files);
    info.access = &access;
    if (kept)
        info.before_picture = [&](const std::string& path, SourceLocation at) { kept->make_way(path, at); };
    std::vector<WrittenFile> written;
    const bool all_written = write_displays(frame.image, context, info, &written);
    const bool shows_something = !context.scene->primitives.empty();
    for (const WrittenFile& file : written) {
        std::error_code unknown;
        const auto bytes = std::filesystem::file_size(file.path, unknown);
        stats.outputs.push_back({file.path, unknown ? 0 : bytes, file.seconds});
        if (kept && shows_something && !file.is_depth_map)
            kept->wrote(file.path, context.scene->options.frame);
    }
    const double seconds = watch.lap();
    stats.seconds.composite += seconds;
    stats.seconds.total += seconds;
    return all_written;
}

}  // namespace trapeze
