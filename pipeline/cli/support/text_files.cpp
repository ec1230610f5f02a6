#include "pipeline/cli/support/text_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "core/files/output_file.h"

namespace trapeze {
namespace {

bool report(const std::string& path, const OutputFile& file, Diagnostics& diagnostics) {
    diagnostics.error({}, fmt::format("cannot write \"{}\": {}", path, file.error()));
    return false;
}

}  // namespace

bool can_write(std::initializer_list<std::string> paths, Diagnostics& diagnostics) {
    for (const std::string& path : paths) {
        if (path.empty()) continue;
        OutputFile file(path);
        if (!file.open()) return report(path, file, diagnostics);
    }
    return true;
}

bool make_folder(const std::string& path, Diagnostics& diagnostics) {
    std::error_code failed;
    std::filesystem::create_directories(path, failed);
    if (!failed && std::filesystem::is_directory(path, failed)) return true;
    diagnostics.error({}, fmt::format("cannot make the folder \"{}\": {}", path,
                                      failed ? failed.message() : "a file is in its place"));
    return false;
}

bool may_write_report(const std::string& path, const Access& access, Diagnostics& diagnostics) {
    // Devices and pipes are the user's way to look at it.
    std::error_code ignored;
    if (path.empty() || path == "-" || std::filesystem::is_other(path, ignored) ||
        std::filesystem::is_fifo(path, ignored) || std::filesystem::is_character_file(path, ignored))
        return true;
    const Access::Writing writing = access.may_write(path);
    char first = 0;
    std::ifstream(path) >> first;
    const bool is_report = first == '{' || first == '[';
    if (!writing.problem.empty() && (access.is_confined() || (writing.is_elsewhere && !is_report))) {
        const std::string why =
            access.is_confined() ? writing.problem : "the file that is there is no report of a run";
        diagnostics.error({}, fmt::format("cannot write \"{}\": {}", path, why));
        return false;
    }
    if (writing.is_elsewhere)
        diagnostics.note({}, fmt::format("\"{}\" lies outside of the working folder", path),
                         "written-elsewhere");
    return true;
}

bool write_text(const std::string& path, const std::string& text, Terminal& terminal,
                Diagnostics& diagnostics) {
    OutputFile file(path);
    if (!file.open() || !file.write(text.data(), text.size()) || !file.commit())
        return report(path, file, diagnostics);
    terminal.say_on_terminal("wrote " + path);
    return true;
}

}  // namespace trapeze
