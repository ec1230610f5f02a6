#include "pipeline/checkpoint/run_origin.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "core/files/sha256.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

std::string text_of(const RecordedOption* option) {
    if (!option) return "not given";
    return option->values.empty() ? "given" : fmt::format("{}", fmt::join(option->values, " "));
}

const RecordedOption* find_option(const std::vector<RecordedOption>& options, const std::string& name) {
    const auto found = std::ranges::find(options, name, &RecordedOption::name);
    return found == options.end() ? nullptr : &*found;
}

}  // namespace

bool SeenFile::is_like(const SeenFile& other) const {
    if (bytes != other.bytes) return false;
    return sha256.empty() || other.sha256.empty() ? modified == other.modified : sha256 == other.sha256;
}

std::optional<SeenFile> FileLooker::look(const std::string& name) {
    std::error_code failed;
    if (!fs::is_regular_file(name, failed)) return {};
    SeenFile file{name, fs::file_size(name, failed), "", 0};
    if (failed) return {};
    const auto date = fs::last_write_time(name, failed);
    if (failed) return {};
    file.modified = std::chrono::duration_cast<std::chrono::nanoseconds>(date.time_since_epoch()).count();
    SeenFile& known = seen_[name];
    if (known.name == name && known.bytes == file.bytes && known.modified == file.modified) return known;
    if (file.bytes <= kMostBytesHashed) {
        const auto hash = hash_of_file(name);
        if (!hash) return {};
        file.bytes = hash->bytes, file.sha256 = hash->sha256;
    }
    return known = file;
}

std::vector<std::string> changed_settings(const RunOrigin& then, const RunOrigin& now) {
    std::vector<std::string> changes;
    if (then.version != now.version || then.revision != now.revision)
        changes.push_back(fmt::format("the program was version {} ({}), is {} ({})", then.version,
                                      then.revision, now.version, now.revision));
    std::vector<std::string> names;
    for (const auto* options : {&then.options, &now.options})
        for (const RecordedOption& option : *options)
            if (std::ranges::find(names, option.name) == names.end()) names.push_back(option.name);
    for (const std::string& name : names) {
        const RecordedOption* const was = find_option(then.options, name);
        const RecordedOption* const is = find_option(now.options, name);
        if (was && is && *was == *is) continue;
        changes.push_back(fmt::format("{} was {}, is {}", name, text_of(was), text_of(is)));
    }
    return changes;
}

std::vector<std::string> changed_files(const std::vector<SeenFile>& then, FileLooker& looker) {
    std::vector<std::string> changes;
    for (const SeenFile& was : then) {
        const auto is = looker.look(was.name);
        if (!is)
            changes.push_back(fmt::format("\"{}\" is gone", was.name));
        else if (!is->is_like(was))
            changes.push_back(fmt::format("\"{}\" has changed", was.name));
    }
    return changes;
}

}  // namespace trapeze
