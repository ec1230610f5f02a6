/// Colours by a config of OpenColorIO, as what reads and writes pictures uses them. What knows OpenColorIO is
/// in composite/colors.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

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

    /// The name of the config's colour space that goes by this name, alias or role; empty: none does.
    virtual std::string space_named(std::string_view name) const = 0;
    /// All names of colour spaces, in quotes, for messages.
    virtual std::string spaces_listed() const = 0;
    /// The colour space of a file by the config's rules for names of files; empty where none is for this one,
    /// but the rule for all others.
    virtual std::string space_of_file(const std::string& path) const = 0;
    /// From a colour space of the config to the working space. Null where nothing is to be done, or, with
    /// *problem set, where that is not possible.
    virtual std::shared_ptr<const ColorTransform> from_space(const std::string& space,
                                                             std::string* problem) const = 0;
};

}  // namespace trapeze
