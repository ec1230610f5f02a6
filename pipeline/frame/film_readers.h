/// Whoever reads a film while regions are added to it.
#pragma once

#include "composite/film/film.h"
#include "pipeline/frame/film_keeper.h"
#include "pipeline/frame/film_watcher.h"

namespace trapeze {

/// Lets the keeper and the watcher read a film from the constructor to end(), and no longer, even where
/// memory runs out.
class FilmReaders {
  public:
    /// The keeper has begun the film already; `asked` is the frame's context as it was asked for. Keeper and
    /// watcher may be null.
    FilmReaders(const Film& film, const RenderContext& asked, FilmKeeper* keeper, FilmWatcher* watcher)
        : keeper_(keeper), watcher_(watcher) {
        if (watcher_) watcher_->begin(film, asked);
    }
    ~FilmReaders() { end(true); }
    FilmReaders(const FilmReaders&) = delete;
    FilmReaders& operator=(const FilmReaders&) = delete;

    void end(bool is_cancelled) noexcept {
        if (watcher_) watcher_->end();
        if (keeper_) keeper_->end(is_cancelled);
        watcher_ = nullptr, keeper_ = nullptr;
    }

  private:
    FilmKeeper* keeper_;
    FilmWatcher* watcher_;
};

}  // namespace trapeze
