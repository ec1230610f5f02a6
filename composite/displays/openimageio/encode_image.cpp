/// The module "displays": pictures in the formats of OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <memory>

#include "composite/displays/image_library.h"

namespace trapeze {
namespace {

OIIO::TypeDesc type_of(NumberType type) {
    switch (type) {
        case NumberType::Uint8:
            return OIIO::TypeDesc::UINT8;
        case NumberType::Uint16:
            return OIIO::TypeDesc::UINT16;
        case NumberType::Float:
            return OIIO::TypeDesc::FLOAT;
    }
    return OIIO::TypeDesc::UNKNOWN;
}

/// Visitor of ImageForm::Value: each type of value has its own call in OpenImageIO.
struct SetAttribute {
    OIIO::ImageSpec& spec;
    const std::string& name;

    void operator()(int value) const { spec.attribute(name, value); }
    void operator()(float value) const { spec.attribute(name, value); }
    void operator()(const std::string& value) const { spec.attribute(name, value); }
    void operator()(const M44f& value) const { spec.attribute(name, OIIO::TypeMatrix, &value); }
};

/// ImageForm in OpenImageIO's words. Channels without names get OpenImageIO's own: R G B A.
OIIO::ImageSpec spec_of(const ImageForm& form) {
    OIIO::ImageSpec spec(form.width, form.height, form.channels, type_of(form.type));
    spec.x = form.x, spec.y = form.y;
    spec.full_width = form.full_width, spec.full_height = form.full_height;
    if (!form.channel_names.empty()) {
        spec.channelnames = form.channel_names;
        spec.alpha_channel = form.alpha_channel;
    }
    for (const auto& [name, value] : form.attributes) std::visit(SetAttribute{spec, name}, value);
    return spec;
}

/// The one object that the module offers. It holds nothing, so any thread may use it.
class OpenImageIo final : public ImageLibrary {
  public:
    ImageBytes encode(const ImageForm& form, NumberType numbers, const void* pixels) const override {
        // A file in memory, which grows as it is written. It must outlive `out`, and so stands before it.
        OIIO::Filesystem::IOVecOutput memory;
        // Null where OpenImageIO was built without the format; the error is then the library's, not the
        // output's.
        const auto out = OIIO::ImageOutput::create(form.format);
        if (!out) return {{}, OIIO::geterror()};
        const bool good = out->set_ioproxy(&memory) && out->open(form.format, spec_of(form)) &&
                          out->write_image(type_of(numbers), pixels) && out->close();
        if (good) return {memory.buffer(), {}};
        // Some formats fail and say nothing.
        const std::string problem = out->geterror();
        return {{}, problem.empty() ? "cannot be encoded" : problem};
    }
};

constexpr OpenImageIo kLibrary;

}  // namespace
}  // namespace trapeze

const trapeze::ModuleEntry trapeze_displays_module = {
    TRAPEZE_VERSION, static_cast<const trapeze::ImageLibrary*>(&trapeze::kLibrary)};
