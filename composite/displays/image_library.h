/// What writes pictures in the formats that OpenEXR's library does not: OpenImageIO, in the module
/// "displays".
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/files/module.h"
#include "core/math.h"

namespace trapeze {

/// How a number of a file, or of the pixels given, is stored.
enum class NumberType { Uint8, Uint16, Float };

/// A picture's file but for its pixels, in OpenImageIO's words.
struct ImageForm {
    using Value = std::variant<int, float, std::string, M44f>;

    std::string format;                   ///< "tiff"
    int width = 0, height = 0;            ///< of the pixels that the file has
    int x = 0, y = 0;                     ///< of the first of them in the whole picture
    int full_width = 0, full_height = 0;  ///< of the whole picture
    int channels = 0;
    NumberType type = NumberType::Uint8;                    ///< of the file's numbers
    std::vector<std::string> channel_names;                 ///< empty: R G B A, the fourth being alpha
    int alpha_channel = -1;                                 ///< where they have names; -1: none
    std::vector<std::pair<std::string, Value>> attributes;  ///< in the order in which they are set
};

/// A file's bytes, or why there are none.
struct ImageBytes {
    std::vector<unsigned char> bytes;
    std::string problem;
};

/// What the module offers: the program itself is not linked with OpenImageIO. Any thread may use it.
class ImageLibrary {
  public:
    /// Encodes pixels: row by row, `form.channels` numbers of type `numbers` each.
    virtual ImageBytes encode(const ImageForm& form, NumberType numbers, const void* pixels) const = 0;

  protected:
    ~ImageLibrary() = default;
};

/// The library, from the module "displays"; null, with *problem set, where that cannot be opened.
const ImageLibrary* image_library(std::string* problem);

}  // namespace trapeze

extern "C" {
[[gnu::visibility("default")]] extern const trapeze::ModuleEntry trapeze_displays_module;
}
