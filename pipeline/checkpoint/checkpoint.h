/// A run that can be broken off and gone on with: what it has finished is saved now and then, and at its end
/// if that comes early.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/diagnostics.h"
#include "core/files/read_names.h"
#include "pipeline/checkpoint/checkpoint_file.h"
#include "pipeline/frame/film_keeper.h"

namespace trapeze {

struct CheckpointSettings {
    std::string path;       ///< of the file
    double interval = 300;  ///< seconds from one save to the next
    bool resumes = false;   ///< goes on with what the file has
    RunOrigin origin;       ///< of the run; its files are found as they are read
};

/// The checkpoint of a run over the worlds of an input, in order. The thread that renders calls all but
/// save_at_end(); another one saves. At most one for a path.
class Checkpoint final : public FilmKeeper {
  public:
    /// `reads` gets the names of the files that the run reads.
    Checkpoint(CheckpointSettings settings, std::shared_ptr<const ReadNames> reads, Diagnostics& diagnostics);
    ~Checkpoint() override;
    Checkpoint(const Checkpoint&) = delete;
    Checkpoint& operator=(const Checkpoint&) = delete;

    /// Whether the file may be written; reports why not.
    bool can_write() const;
    /// Reads what there is to go on with, and begins to save. False, and reported, if that is of another run.
    bool open();
    /// After open(): forgets what was read, and says why.
    void begin_anew(const std::string& why);
    /// Whether the run is not to go on, as what is saved is of another one.
    bool refused() const { return refused_; }

    /// World `index` of the input, from 0, has been read and is the next; what is known of it if it was
    /// rendered before. refused() after it where it reads what it did not read then.
    const FinishedWorld* begin_world(size_t index);
    void finish_world(FinishedWorld world, const std::map<std::string, int>& kept);
    /// Whether a request for a map, counted from 0, was carried out before.
    bool has_made_map(int index) const { return state_.maps.contains(index); }
    void finish_map(int index, const std::string& file);
    /// A picture of this name, as the scene calls it, is kept in the run as a map may need it.
    void keeps_pass(const std::string& name);
    const CheckpointState& state() const { return state_; }

    bool begin(Film& film) override;
    void end(bool is_cancelled) noexcept override;
    void give_up(const std::string& why) override;
    int regions_at_least() const override { return state_.regions; }

    /// Saves what is finished, as the run is about to end early; once. Thread-safe. Returns what to say.
    std::string save_at_end();
    /// The run is complete: removes the file.
    void remove();

  private:
    /// How far a run is: worlds, maps, tiles.
    struct Progress {
        size_t worlds = 0, maps = 0, tiles = 0;
        auto operator<=>(const Progress&) const = default;
    };

    void save_now_and_then();
    /// The functions below want mutex_.
    Progress progress() const;
    bool save(bool in_any_case);
    void save_at_end_now();
    bool note_files();
    std::set<std::string> written_paths() const;
    void note_written();
    void refuse_what_is_new();
    void refuse(const std::string& why);
    bool take_tiles(Film& film);

    const CheckpointSettings settings_;
    const std::shared_ptr<const ReadNames> reads_;
    Diagnostics& diagnostics_;

    std::mutex mutex_;
    std::condition_variable wake_;
    std::thread saver_;
    bool done_ = false, refused_ = false;
    std::optional<std::string> end_;  ///< what there is to say of the last save, once it was
    bool saves_ = true;               ///< until something prevents it
    CheckpointState state_;
    Progress saved_;                             ///< what the file has
    std::unique_ptr<CheckpointReader> resumed_;  ///< until its tiles are in their film
    size_t world_ = 0;                           ///< the one that is rendered
    Film* film_ = nullptr;                       ///< of the world after the finished ones
    size_t restored_ = 0;                        ///< tiles that it began with
    FileLooker looker_;
};

}  // namespace trapeze
