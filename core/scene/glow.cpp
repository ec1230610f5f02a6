#include "core/scene/glow.h"

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

/// Sets a value from the parameter of its name, clamped.
class GlowParameters {
  public:
    GlowParameters(const ShaderInstance& imager, Diagnostics* diagnostics)
        : imager_(imager), diagnostics_(diagnostics) {}

    void take(const char* name, float least, float most, float& value) const {
        const Parameter* given = imager_.parameters.find(name);
        if (!given) return;
        if (given->floats.size() != 1 || !std::isfinite(given->floats[0]))
            return warn(std::string("\"") + name + "\" is not a number; left out");
        value = std::clamp(given->floats[0], least, most);
        if (value != given->floats[0])
            warn(std::string("\"") + name + "\" is out of range; the nearest value is used");
    }

    void warn_of_others() const {
        for (const Parameter& given : imager_.parameters.values)
            if (given.name != "amount" && given.name != "size" && given.name != "threshold")
                warn("there is no parameter \"" + given.name + "\": there are amount, size and threshold");
    }

  private:
    void warn(const std::string& text) const {
        if (diagnostics_) diagnostics_->warning(imager_.location, "Imager: \"glow\": " + text);
    }

    const ShaderInstance& imager_;
    Diagnostics* diagnostics_;
};

}  // namespace

float Glow::pixels_x(int picture_width) const {
    return std::min(size * static_cast<float>(picture_width), kMostPixels);
}

float Glow::pixels_y(int picture_width) const {
    return std::min(pixels_x(picture_width) * pixel_aspect, kMostPixels);
}

std::optional<Glow> find_glow(const Options& options, Diagnostics* diagnostics) {
    if (!options.glow) return {};
    Glow glow;
    const GlowParameters parameters(*options.glow, diagnostics);
    parameters.take("amount", 0, 1, glow.amount);
    parameters.take("size", 0, Glow::kMostSize, glow.size);
    parameters.take("threshold", 0, kInfinity, glow.threshold);
    parameters.warn_of_others();
    glow.pixel_aspect = options.pixel_aspect;
    if (!(glow.amount > 0) || !(glow.size > 0)) return {};
    return glow;
}

}  // namespace trapeze
