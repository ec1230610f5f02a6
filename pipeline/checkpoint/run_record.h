/// What it takes to repeat a run, in its JSON: options as the command line takes them, and which files it
/// read.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

namespace trapeze {

/// An option under its long name, without dashes, and the texts that were, or could have been, given to it:
/// none is a switch, several an option that is repeated.
struct RecordedOption {
    std::string name;
    std::vector<std::string> values;

    bool operator==(const RecordedOption&) const = default;
};

/// A file that was read. Without a hash nothing is known of what was in it: it was no regular file.
struct InputFile {
    std::string name;  ///< as the user or the scene named it
    uint64_t bytes = 0;
    std::string sha256;

    bool operator==(const InputFile&) const = default;
};

/// Under this name the user's own defaults are listed, wherever they are on this machine.
inline constexpr const char* kUserDefaults = "(the user's trapeze.rib)";

/// Sizes and hashes of the files as they are now, by name. The names are those to open.
std::vector<InputFile> hashed_inputs(const std::set<std::string>& names);

/// {"samples": "1x1,2x2", "option": ["..."], "quick": true}
nlohmann::ordered_json to_json(const std::vector<RecordedOption>& options);
/// [{"name": "a.rib", "bytes": 12, "sha256": "..."}]; the hash is null where there is none.
nlohmann::ordered_json to_json(const std::vector<InputFile>& inputs);

}  // namespace trapeze
