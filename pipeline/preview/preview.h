/// A run that is watched: its pictures are shown by viewers while they are made [decision 0041].
#pragma once

#include <memory>
#include <mutex>
#include <string_view>
#include <thread>
#include <vector>

#include "pipeline/frame/film_watcher.h"
#include "pipeline/preview/preview_board.h"

namespace trapeze {

/// A program outside that shows pictures. It works in threads of its own from its construction on.
class PreviewViewer {
  public:
    virtual ~PreviewViewer() = default;
    /// The board has ended: shows what is left, as long as that gets on, and returns.
    virtual void finish() = 0;
};

/// Copies what is finished of a film now and then, in a thread of its own, so that whoever renders waits for
/// no viewer: it waits for copies of pixels alone.
class Preview final : public FilmWatcher {
  public:
    /// `most_bytes`: as PreviewBoard has it.
    explicit Preview(size_t most_bytes = ~size_t{0});
    /// Ends the run for all viewers.
    ~Preview() override;
    Preview(const Preview&) = delete;
    Preview& operator=(const Preview&) = delete;

    const PreviewBoard& board() const { return board_; }
    /// The board's viewers; none of them is null.
    void add(std::unique_ptr<PreviewViewer> viewer) { viewers_.push_back(std::move(viewer)); }

    void begin_stage(std::string_view name) { board_.begin_stage(name); }
    void progress(double fraction) { board_.progress(fraction); }

    void begin(const Film& film, const RenderContext& context) noexcept override;
    void end() noexcept override;
    void show(const Image& image, const RenderContext& context) override;

  private:
    void begin_picture(const Film& film, const RenderContext& context, const PixelRect& window);
    void copy_now_and_then();
    void copy_finished();
    void close_picture();

    PreviewBoard board_;
    std::vector<std::unique_ptr<PreviewViewer>> viewers_;
    std::mutex mutex_;
    std::condition_variable wake_;
    bool done_ = false;
    const Film* film_ = nullptr;     ///< null: there is none to read
    PixelSource source_;             ///< of the film
    std::vector<PixelRect> copied_;  ///< of each tile of the film
    std::shared_ptr<PreviewPicture> picture_;
    std::thread copier_;
};

}  // namespace trapeze
