#include "pipeline/cli/support/pass_pictures.h"

#include <utility>

#include "composite/displays/display_plan.h"
#include "composite/displays/write_displays.h"

namespace trapeze {
namespace {

/// Endings of names by FileFormat: those which every reader takes for what they are.
constexpr const char* kEndings[] = {".exr", ".tif", ".png", ".jpg", ".tga", ".bmp"};

/// Files that are kept at a time: enough for the six sides of two environments, and no burden on the disk
/// when there are a thousand frames.
constexpr size_t kMostFiles = 12;

}  // namespace

void PassPictures::keep(const Display& display, const RenderContext& context, Image image) {
    write_last();
    last_ = std::make_unique<Picture>();
    last_->context = context, last_->image = std::move(image);
    Scene& scene = last_->scene;
    scene.options = context.scene->options;
    scene.camera_from_world = context.scene->camera_from_world;
    // All displays stay: the picture's channels are in their order.
    for (Display& other : scene.options.displays) other.type = "null";
    scene.options.displays.front() = display;
}

void PassPictures::write_last() {
    if (!last_) return;
    const std::unique_ptr<Picture> picture = std::move(last_);
    Display& display = picture->scene.options.displays.front();
    const std::string name = display.name;
    forget(name);
    const auto format = file_format(display);
    display.name = format ? folder_.new_file(kEndings[static_cast<size_t>(*format)]) : "";
    if (display.name.empty()) return;
    // What there is to say of the display has been said.
    Diagnostics unheard;
    picture->context.scene = &picture->scene, picture->context.diagnostics = &unheard;
    std::vector<WrittenFile> written;
    if (!write_displays(picture->image, picture->context, {}, &written) || written.empty()) return;
    files_.push_back({name, written.front().path});
    if (files_.size() > kMostFiles) forget(std::string(files_.front().name));
}

std::optional<std::string> PassPictures::file_of(const std::string& name) {
    if (last_ && last_->scene.options.displays.front().name == name) write_last();
    for (const File& file : files_)
        if (file.name == name) return file.path;
    return {};
}

void PassPictures::forget(const std::string& name) {
    if (last_ && last_->scene.options.displays.front().name == name) last_.reset();
    for (const File& file : files_)
        if (file.name == name) folder_.remove(file.path);
    std::erase_if(files_, [&](const File& file) { return file.name == name; });
}

void PassPictures::allow_reading(Access& access) const {
    if (!folder_.path().empty()) access.allow_reading_below(folder_.path());
}

}  // namespace trapeze
