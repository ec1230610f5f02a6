/// The module "colors": configs of OpenColorIO.
#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <mutex>

#include "composite/colors/color_library.h"
#include "composite/colors/opencolorio/built_in_config.h"
#include "composite/colors/opencolorio/config_names.h"

namespace trapeze {

namespace ocio = OCIO_NAMESPACE;

namespace {

/// A processor on the CPU, whose every operation is on one pixel.
class ProcessedColors final : public ColorTransform {
  public:
    explicit ProcessedColors(const ocio::ConstProcessorRcPtr& processor)
        : processor_(processor->getDefaultCPUProcessor()) {}

    void apply(float* rgba, size_t pixels) const override {
        ocio::PackedImageDesc row(rgba, static_cast<long>(pixels), 1, 4);
        processor_->apply(row);
        // Logarithms of what is below zero, say. A file of whole numbers has none.
        std::replace_if(
            rgba, rgba + 4 * pixels, [](float value) { return std::isnan(value); }, 0.0f);
    }

  private:
    ocio::ConstCPUProcessorRcPtr processor_;
};

/// The looks of a text like "A, -B | C": each must be there.
void check_looks_of(const ocio::Config& config, const std::string& look) {
    const std::vector<std::string> names = looks_of(config);
    if (std::find(names.begin(), names.end(), look) != names.end()) return;
    for (size_t from = 0; from <= look.size();) {
        const size_t end = std::min(look.find_first_of(",:|", from), look.size());
        std::string name = look.substr(from, end - from);
        name.erase(0, name.find_first_not_of(" +-"));
        name.erase(name.find_last_not_of(' ') + 1);
        static_cast<void>(found_in(names, name, "look"));
        from = end + 1;
    }
}

/// A text of OpenColorIO, or of the parser below it, on one line.
std::string on_one_line(std::string text) {
    std::string line;
    for (const char c : text)
        if (static_cast<unsigned char>(c) > ' ' || static_cast<unsigned char>(c) >= 0x80)
            line += c;
        else if (!line.empty() && line.back() != ' ')
            line += ' ';
    while (line.ends_with(' ')) line.pop_back();
    return line;
}

class OpenedConfig final : public ColorManagement {
  public:
    OpenedConfig(ocio::ConstConfigRcPtr config, const ColorRequest& request)
        : config_(std::move(config)), names_(names_of(*config_, request)), view_(view_processor()) {
        view_is_srgb_ = request.config.empty() && names_.view == kBuiltInView;
    }

    const ColorNames& names() const override { return names_; }
    const ColorTransform& view() const override { return view_; }
    bool view_is_srgb() const override { return view_is_srgb_; }

    std::string space_named(std::string_view name) const override {
        const auto space = config_->getColorSpace(std::string(name).c_str());
        return space ? space->getName() : "";
    }
    std::string spaces_listed() const override { return listed_names(color_spaces_of(*config_)); }

    std::string space_of_file(const std::string& path) const override {
        try {
            if (config_->filepathOnlyMatchesDefaultRule(path.c_str())) return {};
            return space_named(config_->getColorSpaceFromFilepath(path.c_str()));
        } catch (const std::exception&) {
            return {};  // regular expressions have limits
        }
    }

    std::shared_ptr<const ColorTransform> from_space(const std::string& space,
                                                     std::string* problem) const override {
        try {
            const auto processor = config_->getProcessor(space.c_str(), names_.working_space.c_str());
            return processor->isNoOp() ? nullptr : std::make_shared<const ProcessedColors>(processor);
        } catch (const std::exception& error) {
            *problem = on_one_line(error.what());
            return nullptr;
        }
    }

  private:
    /// All names that the request leaves open are the config's usual ones.
    static ColorNames names_of(const ocio::Config& config, const ColorRequest& request) {
        ColorNames names;
        if (request.working_space.empty() && !config.hasRole(ocio::ROLE_SCENE_LINEAR))
            throw ColorProblem(
                "there is no role scene_linear: Option \"ocio\" \"workingspace\" says which colour space "
                "shading is in: " +
                listed_names(color_spaces_of(config)));
        names.working_space = color_space_named(
            config, request.working_space.empty() ? ocio::ROLE_SCENE_LINEAR : request.working_space);
        const std::vector<std::string> displays = displays_of(config);
        if (displays.empty()) throw ColorProblem("there is no display");
        names.display = request.display.empty() ? config.getDefaultDisplay()
                                                : found_in(displays, request.display, "display");
        const std::vector<std::string> views = views_of(config, names.display);
        if (views.empty()) throw ColorProblem("display \"" + names.display + "\" has no view");
        names.view = request.view.empty()
                         ? config.getDefaultView(names.display.c_str())
                         : found_in(views, request.view, "view of display \"" + names.display + "\"");
        if (!request.look.empty()) check_looks_of(config, request.look);
        names.look = request.look;
        return names;
    }

    /// As OpenImageIO's tools make it, too: a look that is asked for is in place of the view's own.
    ocio::ConstProcessorRcPtr view_processor() const {
        const auto transform = ocio::DisplayViewTransform::Create();
        transform->setSrc(names_.working_space.c_str());
        transform->setDisplay(names_.display.c_str());
        transform->setView(names_.view.c_str());
        const auto pipeline = ocio::LegacyViewingPipeline::Create();
        pipeline->setDisplayViewTransform(transform);
        pipeline->setLooksOverrideEnabled(!names_.look.empty());
        pipeline->setLooksOverride(names_.look.c_str());
        return pipeline->getProcessor(config_, config_->getCurrentContext());
    }

    ocio::ConstConfigRcPtr config_;
    ColorNames names_;
    ProcessedColors view_;
    bool view_is_srgb_ = false;
};

/// OpenColorIO says some things on the standard error output; what matters it throws.
void silence() {
    static std::once_flag done;
    std::call_once(done, [] { ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE); });
}

/// The one object that the module offers. It holds nothing, so any thread may use it.
class OpenColorIo final : public ColorLibrary {
  public:
    std::shared_ptr<const ColorManagement> open(const ColorRequest& request,
                                                std::string* problem) const override {
        try {
            silence();
            const ocio::ConstConfigRcPtr config = request.config.empty()
                                                      ? make_built_in_config()
                                                      : ocio::Config::CreateFromFile(request.config.c_str());
            return std::make_shared<const OpenedConfig>(config, request);
        } catch (const std::exception& error) {
            *problem = on_one_line(error.what());
            if (problem->empty()) *problem = "cannot be read";
            return {};
        }
    }
};

constexpr OpenColorIo kColors;

}  // namespace
}  // namespace trapeze

const trapeze::ModuleEntry trapeze_colors_module = {
    TRAPEZE_VERSION, static_cast<const trapeze::ColorLibrary*>(&trapeze::kColors)};
