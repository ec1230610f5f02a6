/// Whoever looks at a frame's pictures while they are made, and changes nothing of them.
#pragma once

namespace trapeze {

struct Image;
struct RenderContext;
class Film;

/// Called by the thread that renders the frame, which waits for each call.
class FilmWatcher {
  public:
    virtual ~FilmWatcher() = default;

    /// A film has begun, and has what an earlier run has finished; until end(), other threads may read what
    /// is finished of it (Film::finished_pixels()). `context` is the frame's as it was asked for: its crop is
    /// the picture's, and the film may have a margin around it. Both live until end(). Called again, after an
    /// end(), where the frame begins anew.
    virtual void begin(const Film& film, const RenderContext& context) noexcept = 0;
    /// Nothing is to be read any more: the film is to be finished, or was cancelled.
    virtual void end() noexcept = 0;
    /// The whole picture of the film that has ended, as it will be written.
    virtual void show(const Image& image, const RenderContext& context) = 0;
};

}  // namespace trapeze
