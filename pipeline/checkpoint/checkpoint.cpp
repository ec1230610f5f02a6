#include "pipeline/checkpoint/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <new>

#include "composite/film/film.h"
#include "core/files/output_file.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

/// A picture that no attempt gets on with is split into twice as many regions by the next one, up to so many.
constexpr int kMostRegions = 4096;

/// One name for a path, however it is written.
std::string key_of(const std::string& path) {
    std::error_code failed;
    const fs::path whole = fs::weakly_canonical(path, failed);
    return failed ? path : whole.string();
}

}  // namespace

Checkpoint::Checkpoint(CheckpointSettings settings, std::shared_ptr<const ReadNames> reads,
                       Diagnostics& diagnostics)
    : settings_(std::move(settings)), reads_(std::move(reads)), diagnostics_(diagnostics) {
    state_.origin = settings_.origin;
}

Checkpoint::~Checkpoint() {
    {
        const std::lock_guard lock(mutex_);
        done_ = true;
    }
    wake_.notify_all();
    if (saver_.joinable()) saver_.join();
}

bool Checkpoint::can_write() const {
    std::error_code ignored;
    std::string problem;
    if (fs::exists(settings_.path, ignored) && !is_checkpoint(settings_.path))
        problem = "what is there is no checkpoint";
    if (OutputFile file(settings_.path); problem.empty() && !file.open()) problem = file.error();
    if (problem.empty()) return true;
    diagnostics_.error({}, fmt::format("cannot write the checkpoint \"{}\": {}", settings_.path, problem));
    return false;
}

bool Checkpoint::open() {
    OutputFile::remove_leftovers(settings_.path);
    std::error_code ignored;
    if (settings_.resumes && !fs::exists(settings_.path, ignored))
        diagnostics_.note({}, fmt::format("there is no checkpoint \"{}\" to go on with: the run begins anew",
                                          settings_.path));
    else if (settings_.resumes) {
        std::string problem;
        resumed_ = CheckpointReader::open(settings_.path, &problem);
        if (!resumed_)
            diagnostics_.warning({},
                                 fmt::format("cannot go on with the checkpoint \"{}\": {}; the run begins "
                                             "anew",
                                             settings_.path, problem));
    }
    if (resumed_) {
        CheckpointState& state = resumed_->state();
        std::vector<std::string> changes = changed_settings(state.origin, settings_.origin);
        std::ranges::move(changed_files(state.origin.files, looker_), std::back_inserter(changes));
        for (const std::string& change : changes) refuse(change);
        if (refused_) return false;
        state_ = state;
        saved_ = {state.worlds.size(), state.maps.size(), static_cast<size_t>(std::max(0, state.tiles))};
        if (const auto other = changed_files(state_.written, looker_); !other.empty())
            begin_anew(fmt::format("{} since it was written", other.front()));
    }
    saver_ = std::thread([this] { save_now_and_then(); });
    return true;
}

void Checkpoint::begin_anew(const std::string& why) {
    const std::lock_guard lock(mutex_);
    diagnostics_.note({}, fmt::format("{}: the run begins anew", why));
    resumed_.reset();
    saved_ = {};
    state_ = {};
    state_.origin = settings_.origin;
}

const FinishedWorld* Checkpoint::begin_world(size_t index) {
    const std::lock_guard lock(mutex_);
    world_ = index;
    if (index >= state_.worlds.size()) return nullptr;
    refuse_what_is_new();
    return &state_.worlds[index];
}

void Checkpoint::finish_world(FinishedWorld world, const std::map<std::string, int>& kept) {
    const std::lock_guard lock(mutex_);
    // Until a later world has more, its tiles stay where they are.
    if (world.failed && world_ >= state_.worlds.size()) return;
    if (state_.worlds.size() <= world_) state_.worlds.resize(world_ + 1);
    state_.worlds[world_] = std::move(world);
    state_.kept = kept;
    state_.regions = 1;
    note_written();
}

void Checkpoint::finish_map(int index, const std::string& file) {
    const std::lock_guard lock(mutex_);
    state_.maps.insert(index);
    state_.map_files.insert(file);
    note_written();
}

void Checkpoint::keeps_pass(const std::string& name) {
    const std::lock_guard lock(mutex_);
    state_.passes.insert(name);
}

/// Looks at all pictures and maps that are there now.
void Checkpoint::note_written() {
    std::set<std::string> paths = state_.map_files;
    for (const auto& [path, frame] : state_.kept) paths.insert(path);
    for (const FinishedWorld& world : state_.worlds)
        paths.insert(world.pictures.begin(), world.pictures.end());
    state_.written.clear();
    for (const std::string& path : paths)
        if (const auto file = looker_.look(path)) state_.written.push_back(*file);
}

std::set<std::string> Checkpoint::written_paths() const {
    std::set<std::string> paths;
    for (const SeenFile& file : state_.written) paths.insert(key_of(file.name));
    return paths;
}

bool Checkpoint::begin(Film& film) {
    const std::lock_guard lock(mutex_);
    film_ = nullptr;
    // One that is tried again has those after it behind it in the file.
    if (world_ < state_.worlds.size()) return true;
    state_.worlds.resize(world_);
    restored_ = 0;
    if (resumed_ && !take_tiles(film)) return false;
    resumed_.reset();
    film_ = &film;
    return true;
}

/// Puts the tiles of the checkpoint into their film; false, and reported, where they are of something else.
bool Checkpoint::take_tiles(Film& film) {
    // Saved before the picture was begun: what it reads of its own was not known then.
    if (state_.tiles <= 0) return true;
    refuse_what_is_new();
    if (!refused_ &&
        !film.read_finished([this](void* to, size_t count) { return resumed_->read(to, count); }))
        refuse("its tiles are those of another picture");
    restored_ = film.finished_tiles().size();
    if (!refused_)
        diagnostics_.note(
            {}, fmt::format("goes on with {} of {} tiles of the picture", restored_, film.picture_tiles()));
    return !refused_;
}

/// What is read by the time that a finished world ends, or that a film begins of which there are tiles, was
/// read then, too: scenes, archives, shaders. Textures and maps follow, and may have been read no sooner.
void Checkpoint::refuse_what_is_new() {
    const std::set<std::string> written = written_paths();
    std::set<std::string> known;
    for (const SeenFile& file : state_.origin.files) known.insert(file.name);
    for (const std::string& name : reads_->names())
        if (!known.contains(name) && !written.contains(key_of(name)) && looker_.look(name))
            refuse(fmt::format("\"{}\" is read now, and was not read then", name));
}

void Checkpoint::refuse(const std::string& why) {
    diagnostics_.error({}, fmt::format("cannot go on with the checkpoint \"{}\": {}", settings_.path, why));
    refused_ = true;
}

void Checkpoint::end(bool is_cancelled) noexcept {
    const std::lock_guard lock(mutex_);
    try {
        if (is_cancelled) save_at_end_now();
    } catch (const std::bad_alloc&) {  // what was saved before stays, and save_at_end() tells of it
    }
    film_ = nullptr;
}

void Checkpoint::give_up(const std::string& why) {
    const std::lock_guard lock(mutex_);
    diagnostics_.warning({}, fmt::format("nothing of this picture is saved before it is whole: {}", why));
    film_ = nullptr;
    resumed_.reset();
    if (saved_.tiles > 0 && saved_.worlds == state_.worlds.size()) save(true);
}

Checkpoint::Progress Checkpoint::progress() const {
    return {state_.worlds.size(), state_.maps.size(), film_ ? film_->finished_tiles().size() : 0};
}

void Checkpoint::save_now_and_then() {
    std::unique_lock lock(mutex_);
    while (!done_) {
        wake_.wait_for(lock, std::chrono::duration<double>(settings_.interval), [this] { return done_; });
        if (!done_) save(false);
    }
}

/// Adds the files that have been read to the state; false where one has changed since it was first seen, so
/// that what is finished may be of either.
bool Checkpoint::note_files() {
    std::vector<SeenFile>& files = state_.origin.files;
    std::map<std::string, size_t> places;
    for (size_t i = 0; i < files.size(); ++i) places.emplace(files[i].name, i);
    const std::set<std::string> written = written_paths();
    for (const std::string& name : reads_->names()) {
        const auto file = looker_.look(name);
        const auto place = places.find(name);
        if (place != places.end() ? file && file->is_like(files[place->second])
                                  : !file || written.contains(key_of(name)))
            continue;
        if (place == places.end()) {
            files.push_back(*file);
            continue;
        }
        saves_ = false;
        diagnostics_.warning({},
                             fmt::format("nothing more is saved in \"{}\": \"{}\" has changed since it was "
                                         "read",
                                         settings_.path, name));
        return false;
    }
    return true;
}

/// Saves where there is more than the file has; false where nothing was written.
bool Checkpoint::save(bool in_any_case) {
    const Progress now = progress();
    // Until then the file's tiles are nowhere else.
    const bool waits = resumed_ && state_.tiles > 0;
    if (!saves_ || waits || (!in_any_case && now <= saved_) || !note_files()) return false;
    state_.tiles = static_cast<int>(now.tiles);
    const std::string problem = write_checkpoint(settings_.path, state_, [this](const WriteBytes& write) {
        return !film_ || film_->write_finished(write);
    });
    if (problem.empty()) {
        saved_ = now;
        return true;
    }
    diagnostics_.warning({}, fmt::format("cannot write the checkpoint \"{}\": {}", settings_.path, problem),
                         "checkpoint");
    return false;
}

void Checkpoint::save_at_end_now() {
    if (end_) return;
    // Whoever has had a film and has finished nothing of it takes smaller parts.
    const bool is_stuck = film_ && film_->finished_tiles().size() == restored_;
    if (is_stuck) state_.regions = std::min(2 * std::max(1, state_.regions), kMostRegions);
    save(is_stuck);
    const std::string& path = settings_.path;
    if (film_ && saves_ && saved_.worlds == state_.worlds.size())
        end_ = fmt::format("{} of {} tiles of the picture are saved in \"{}\"; --resume goes on with them",
                           saved_.tiles, film_->picture_tiles(), path);
    else if (std::error_code ignored; fs::exists(path, ignored))
        end_ = fmt::format("what is finished is saved in \"{}\"; --resume goes on with it", path);
    else
        end_ = "nothing is finished yet, and nothing saved";
}

std::string Checkpoint::save_at_end() {
    const std::lock_guard lock(mutex_);
    save_at_end_now();
    return *end_;
}

void Checkpoint::remove() {
    const std::lock_guard lock(mutex_);
    saves_ = false;
    std::error_code ignored;
    if (is_checkpoint(settings_.path)) fs::remove(settings_.path, ignored);
    // Whoever was killed just before this run began may have been there still.
    OutputFile::remove_leftovers(settings_.path);
}

}  // namespace trapeze
