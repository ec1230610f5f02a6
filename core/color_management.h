/// Colours by a config of OpenColorIO, as what reads and writes pictures uses them. What knows OpenColorIO is
/// in composite/colors.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace trapeze {

/// A way from one colour space to another. Any thread may use it.
class ColorTransform {
  public:
    virtual ~ColorTransform() = default;
    /// Converts pixels in place: R G B A each, not multiplied by A; what A becomes means nothing. Each pixel
    /// by itself, so that any split of them gives the same bits.
    virtual void apply(float* rgba, size_t pixels) const = 0;
};

/// The names in use, as the config spells them.
struct ColorNames {
    std::string working_space, display, view, look;  ///< the look is empty where the view decides
};

/// An opened config, with a working space and a view. Any thread may use it.
class ColorManagement {
  public:
    virtual ~ColorManagement() = default;
    virtual const ColorNames& names() const = 0;
    /// From the working space to what the display shows.
    virtual const ColorTransform& view() const = 0;
    /// Whether the view is the plain sRGB curve on Rec.709, which files have a mark for.
    virtual bool view_is_srgb() const = 0;
};

}  // namespace trapeze
