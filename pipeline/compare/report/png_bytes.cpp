#include "pipeline/compare/report/png_bytes.h"

#include <stdexcept>

#include "composite/displays/image_library.h"

namespace trapeze {

/// The bytes are taken as sRGB and written as they are.
std::vector<unsigned char> png_bytes(int width, int height, std::span<const uint8_t> rgb) {
    ImageForm form;
    form.format = "png";
    form.width = form.full_width = width, form.height = form.full_height = height;
    form.channels = 3;
    form.attributes = {{"oiio:ColorSpace", std::string("sRGB")}};
    std::string problem;
    const ImageLibrary* const library = image_library(&problem);
    if (!library) throw std::runtime_error("no PNG: " + problem);
    ImageBytes made = library->encode(form, NumberType::Uint8, rgb.data());
    if (!made.problem.empty()) throw std::runtime_error("no PNG: " + made.problem);
    return std::move(made.bytes);
}

}  // namespace trapeze
