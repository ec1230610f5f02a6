/// The file that holds what a run has finished: pictures and maps that are written, tiles of the one that is
/// not.
///
/// A line that says what it is, the length and the text of a JSON, tiles as Film::write_finished() has them,
/// and 64 digits: the SHA-256 of all before.
#pragma once

#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "composite/film/finished_tiles.h"
#include "pipeline/checkpoint/run_origin.h"

namespace trapeze {

/// A world of the input that has been rendered.
struct FinishedWorld {
    bool failed = true;  ///< it is to be tried again
    bool shows_something = false;
    std::vector<std::string> pictures;  ///< files
};

/// All of a checkpoint but tiles.
struct CheckpointState {
    RunOrigin origin;
    std::vector<FinishedWorld> worlds;
    std::set<int> maps;               ///< requests for maps that were carried out, counted from 0
    std::set<std::string> map_files;  ///< what they have written
    std::set<std::string> passes;     ///< pictures, as the scene calls them, that only a run itself has whole
    std::map<std::string, int> kept;  ///< frames of pictures by path, as KeptPictures has them
    std::vector<SeenFile> written;    ///< pictures and maps, as they were written
    int tiles = 0;                    ///< finished, of the world after `worlds`
    int regions = 1;                  ///< that it is to be split into at least
};

/// Writes a checkpoint, whole or not at all; `write_tiles` gives what follows the state. Returns what is
/// wrong, or nothing.
std::string write_checkpoint(const std::string& path, const CheckpointState& state,
                             const std::function<bool(const WriteBytes&)>& write_tiles);

/// Whether a file begins as checkpoints do.
bool is_checkpoint(const std::string& path);

/// A checkpoint that is open, and was found to be whole.
class CheckpointReader {
  public:
    /// Null, and why, where a file is not a whole checkpoint.
    static std::unique_ptr<CheckpointReader> open(const std::string& path, std::string* problem);

    CheckpointState& state() { return state_; }
    /// The next bytes of the tiles.
    bool read(void* bytes, size_t count);

  private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::unique_ptr<std::FILE, Close> file_;
    uint64_t left_ = 0;  ///< bytes of tiles
    CheckpointState state_;
};

}  // namespace trapeze
