/// Whoever keeps finished tiles of a frame's film where they outlive the process, for a run that goes on
/// with them.
#pragma once

#include <string>

namespace trapeze {

class Film;

/// Called by the thread that renders the frame. Between begin() and end() the film may be read by other
/// threads (Film::write_finished()).
class FilmKeeper {
  public:
    virtual ~FilmKeeper() = default;

    /// The frame has a film, to which nothing was added: puts in what was kept of it. False when the frame
    /// is not to be rendered, which has been reported.
    virtual bool begin(Film& film) = 0;
    /// The film is about to be finished; or, where the frame was cancelled or memory ran out, to go away.
    virtual void end(bool is_cancelled) noexcept = 0;
    /// Nothing of this frame can be kept, nor what was; says why.
    virtual void give_up(const std::string& why) = 0;
    /// Into so many regions the frame is split at least.
    virtual int regions_at_least() const = 0;
};

}  // namespace trapeze
