#include "composite/displays/png_bytes.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <stdexcept>

namespace trapeze {

std::vector<unsigned char> png_bytes(int width, int height, std::span<const uint8_t> rgb) {
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    OIIO::Filesystem::IOVecOutput memory;
    const auto out = OIIO::ImageOutput::create("png");
    if (!out) throw std::runtime_error("no PNG: " + OIIO::geterror());
    const bool good = out->set_ioproxy(&memory) && out->open("png", spec) &&
                      out->write_image(OIIO::TypeDesc::UINT8, rgb.data()) && out->close();
    if (!good) throw std::runtime_error("no PNG: " + out->geterror());
    return memory.buffer();
}

}  // namespace trapeze
