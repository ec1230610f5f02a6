/// What decides the pixels of a run: whether two runs may have parts of one picture.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/checkpoint/run_record.h"

namespace trapeze {

/// A file as it was when it was looked at: by its content, or, where that is large, by its date.
struct SeenFile {
    std::string name;  ///< as it was opened
    uint64_t bytes = 0;
    std::string sha256;    ///< empty: too large to be read for this
    int64_t modified = 0;  ///< nanoseconds of the system's clock of files

    /// Whether the same is in both, as far as is known.
    bool is_like(const SeenFile& other) const;
};

/// Looks at files, and hashes those that it has not seen, or whose size or date have changed.
class FileLooker {
  public:
    /// Nothing where there is no such regular file.
    std::optional<SeenFile> look(const std::string& name);

  private:
    std::map<std::string, SeenFile> seen_;
};

/// Of files up to so many bytes the content counts, of larger ones the date: textures may take a gigabyte.
inline constexpr uint64_t kMostBytesHashed = uint64_t{1} << 26;

struct RunOrigin {
    std::string version, revision;        ///< of the program
    std::vector<RecordedOption> options;  ///< of the command line, those that pixels or files follow from
    std::vector<SeenFile> files;          ///< that were read
};

/// A sentence for each option, and for the program, that is not as it was.
std::vector<std::string> changed_settings(const RunOrigin& then, const RunOrigin& now);

/// A sentence for each file of an earlier run that is not as it was.
std::vector<std::string> changed_files(const std::vector<SeenFile>& then, FileLooker& looker);

}  // namespace trapeze
