#include "pipeline/preview/preview.h"

#include <chrono>
#include <new>

#include "composite/film/film.h"
#include "pipeline/preview/preview_channels.h"

namespace trapeze {
namespace {

/// From one copy of what is finished to the next.
constexpr std::chrono::milliseconds kPause{50};

/// What viewers call a picture: as its first file is called.
std::string name_of(const Options& options) {
    for (const Display& display : options.displays)
        if (!display.name.empty()) return display.name;
    return "picture";
}

}  // namespace

Preview::Preview(size_t most_bytes) : board_(most_bytes), copier_([this] { copy_now_and_then(); }) {}

Preview::~Preview() {
    {
        const std::lock_guard lock(mutex_);
        done_ = true;
    }
    wake_.notify_all();
    copier_.join();
    close_picture();
    board_.end();
    for (const auto& viewer : viewers_) viewer->finish();
}

void Preview::begin(const Film& film, const RenderContext& context) noexcept {
    close_picture();
    const Image& image = film.unfinished();
    const PixelRect window = intersection(context.camera.crop, image.window);
    if (window.empty()) return;
    try {
        begin_picture(film, context, window);
    } catch (const std::bad_alloc&) {  // the film has room, its copy has none: nobody sees it
        const std::lock_guard lock(mutex_);
        film_ = nullptr;
        picture_.reset();
    }
}

void Preview::begin_picture(const Film& film, const RenderContext& context, const PixelRect& window) {
    const Image& image = film.unfinished();
    picture_ = std::make_shared<PreviewPicture>(PreviewFacts{name_of(context.scene->options), image.width,
                                                             image.height, window,
                                                             preview_channels(image, context)});
    {
        const std::lock_guard lock(mutex_);
        source_ = preview_source(image, context);
        copied_.assign(static_cast<size_t>(film.tile_count()), {});
        film_ = &film;
    }
    board_.begin_picture({0, picture_, context.colors, context.scene->options.frame});
}

void Preview::end() noexcept {
    const std::lock_guard lock(mutex_);
    if (!film_) return;
    copy_finished();
    film_ = nullptr;
}

void Preview::show(const Image& image, const RenderContext& context) {
    if (!picture_) return;
    picture_->finish(preview_source(image, context));
    picture_.reset();
    board_.note_change();
}

/// A picture that nobody has shown was cancelled.
void Preview::close_picture() {
    if (!picture_) return;
    picture_->close();
    picture_.reset();
    board_.note_change();
}

void Preview::copy_now_and_then() {
    std::unique_lock lock(mutex_);
    while (!done_) {
        wake_.wait_for(lock, kPause, [this] { return done_; });
        if (!done_ && film_) copy_finished();
    }
}

/// Copies the tiles of which more is finished than before. Wants mutex_.
void Preview::copy_finished() {
    bool any = false;
    for (size_t t = 0; t < copied_.size(); ++t) {
        const PixelRect finished = film_->finished_pixels(static_cast<int>(t));
        if (finished.empty() || finished == copied_[t]) continue;
        picture_->put(finished, source_);
        copied_[t] = finished;
        any = true;
    }
    if (any) board_.note_change();
}

}  // namespace trapeze
