/// A procedural is asked as soon as it is read, for the detail that it has in the finished picture: RISpec
/// 5.8 lets a renderer ask late or never, which saves nothing where all geometry is kept until the frame is
/// rendered.
#include "pipeline/rib/reader/procedurals.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <sstream>

#include "pipeline/rib/programs/find_program.h"

namespace trapeze::rib {

/// How messages begin that are about it.
std::string Procedurals::Source::title() const {
    return "the " + kind + " " + in_quotes(shown);
}

bool Procedurals::takes_procedural() {
    if (state_.in_motion()) throw RequestError{"inside a motion block", {}};
    return scene_.takes_geometry();
}

/// The bound that such a request has is not looked at, since nothing is delayed.
void Procedurals::delayed_archive(const std::string& name) {
    if (!takes_procedural()) return;
    blocks_.within_attribute_block([&] { stream_.read_archive(name); });
}

/// The command is cut at spaces alone: no shell sees it, and nothing in it is expanded.
void Procedurals::run_program(const std::string& command, const std::string& data,
                              const std::vector<float>& bound) {
    std::istringstream stream(command);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    read_answer({"program", command, std::move(words)}, data, bound);
}

/// The library is looked for as it is named, and with the ending that libraries have here.
void Procedurals::load_procedural(const std::string& library, const std::string& data,
                                  const std::vector<float>& bound) {
    if (read_options_.procedural_host.empty())
        throw RequestError{"\"DynamicLoad\" is not supported here", {}};
    namespace fs = std::filesystem;
    std::error_code ignored;
    std::vector<std::string> words = read_options_.procedural_host;
    words.push_back(library);
    for (const std::string& folder : search_.folders("procedural"))
        for (const char* ending : {"", ".so"}) {
            const fs::path path = fs::absolute(fs::path(folder.empty() ? "." : folder) / (library + ending));
            if (words.back() == library && fs::is_regular_file(path, ignored)) words.back() = path.string();
        }
    read_answer({"procedural", library, std::move(words)}, data, bound);
}

/// Strangers' files run nothing unless the user says so. A program that is not there is said even where none
/// may run: to allow it would not help.
bool Procedurals::may_run(const Source& source) {
    if (access_.is_confined()) {
        report_.count_unsupported();
        report_.warn_once("programs are not run (--safe); skipped", "programs-not-allowed");
        return false;
    }
    if (read_options_.allow_programs) return true;
    // A library's name is the last word, after its host's.
    std::error_code ignored;
    const bool is_there =
        source.kind == "program"
            ? !source.words.empty() && has_program(source.words[0], search_.folders("procedural"))
            : std::filesystem::is_regular_file(source.words.back(), ignored);
    report_.count_unsupported();
    if (!is_there) report_.error(source.title() + " is not found");
    report_.warn_once("programs are run only where that is allowed (--allow-programs); skipped",
                      "programs-not-allowed");
    return false;
}

/// Frames that are not wanted start no programs. The answer is read like a file of the scene's, with the
/// places of messages in it.
void Procedurals::read_answer(const Source& source, const std::string& data,
                              const std::vector<float>& bound) {
    if (!takes_procedural() || !may_run(source) || !scene_.frame_is_wanted()) return;
    const std::string name = "<" + source.kind + " " + clipped(source.shown) + ">";
    if (!stream_.may_read_archive(name, {})) return;
    // The request is a line of the bound's area in pixels, and the scene's data. Infinite areas are large.
    char detail[32];
    const float area = bound.empty() ? 0 : std::min(state_.raster_area(bound), 1e38f);
    const char* const end = std::to_chars(detail, detail + sizeof detail, area).ptr;
    const ProgramAnswer answer =
        ask(source, std::string(static_cast<const char*>(detail), end) + " " + data + "\n");
    if (report_.must_stop()) return;
    if (!answer.problem.empty()) report_.error(source.title() + " " + answer.problem);
    if (answer.text.empty()) return;
    const uint32_t id = report_.diagnostics().add_source(name, report_.at());
    const OpenFiles::Entry entry(files_, name);
    blocks_.within_attribute_block([&] { stream_.read_text(answer.text, {id, 1, 1}); });
}

/// A program's answer is limited as a file is, and its waiting ends with the reading
/// (ReadOptions::cancelled).
ProgramAnswer Procedurals::ask(const Source& source, const std::string& request) {
    AnswerLimits limits;
    limits.silence = std::chrono::milliseconds(static_cast<int64_t>(read_options_.program_seconds * 1000));
    limits.most_bytes = read_options_.max_source_bytes;
    limits.cancelled = read_options_.cancelled;
    if (read_options_.on_wait)
        limits.on_wait = [&](int seconds) { read_options_.on_wait(source.title(), seconds); };
    return programs_.ask(source.words, request, search_.folders("procedural"), limits);
}

}  // namespace trapeze::rib
