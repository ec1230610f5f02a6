#include "shade/maps/openimageio/map_bytes.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <memory>

namespace trapeze {
namespace {

/// The bytes that this thread makes now. make_texture() makes its writer itself, from a format's name: this
/// is the only way to hand it anything.
thread_local MapBytes* making = nullptr;

/// Writes an OpenEXR file into memory, and hands it to `making` when it is closed.
class MemoryOutput : public OIIO::ImageOutput {
  public:
    MemoryOutput() : inner_(OIIO::ImageOutput::create("openexr")) {}

    const char* format_name() const override { return "openexr"; }
    int supports(OIIO::string_view feature) const override { return inner_ ? inner_->supports(feature) : 0; }

    bool open(const std::string& name, const OIIO::ImageSpec& spec, OpenMode mode) override {
        if (!inner_ || (mode == Create && !inner_->set_ioproxy(&memory_))) return failed();
        is_open_ = inner_->open(name, spec, mode);
        m_spec = inner_->spec();
        return is_open_ || failed();
    }
    bool close() override {
        if (!is_open_) return true;
        is_open_ = false;
        if (!inner_->close()) return failed();
        if (making) making->bytes = memory_.buffer();
        return true;
    }

    bool write_scanlines(int ybegin, int yend, int z, OIIO::TypeDesc format, const void* data,
                         OIIO::stride_t xstride, OIIO::stride_t ystride) override {
        return inner_->write_scanlines(ybegin, yend, z, format, data, xstride, ystride) || failed();
    }
    bool write_tiles(int xbegin, int xend, int ybegin, int yend, int zbegin, int zend, OIIO::TypeDesc format,
                     const void* data, OIIO::stride_t xstride, OIIO::stride_t ystride,
                     OIIO::stride_t zstride) override {
        return inner_->write_tiles(xbegin, xend, ybegin, yend, zbegin, zend, format, data, xstride, ystride,
                                   zstride) ||
               failed();
    }
    bool write_image(OIIO::TypeDesc format, const void* data, OIIO::stride_t xstride, OIIO::stride_t ystride,
                     OIIO::stride_t zstride, OIIO::ProgressCallback progress, void* progress_data) override {
        return inner_->write_image(format, data, xstride, ystride, zstride, progress, progress_data) ||
               failed();
    }

  private:
    bool failed() {
        errorfmt("{}", inner_ ? inner_->geterror() : OIIO::geterror());
        return false;
    }

    bool is_open_ = false;
    OIIO::Filesystem::IOVecOutput memory_;
    std::unique_ptr<OIIO::ImageOutput> inner_;
};

OIIO::ImageOutput* make_memory_output() {
    return new MemoryOutput;
}

/// Registers the writer, once. Returns the format's name by which OpenImageIO finds it.
const char* memory_format() {
    static const bool declared = [] {
        const char* no_extensions[] = {nullptr};
        OIIO::declare_imageio_format("trapezememory", nullptr, nullptr, make_memory_output, no_extensions,
                                     nullptr);
        return true;
    }();
    return declared ? "trapezememory" : "";
}

}  // namespace

MapBytes open_exr_texture(const OIIO::ImageBuf& picture, OIIO::ImageSpec config) {
    config.attribute("maketx:fileformatname", memory_format());
    MapBytes made;
    making = &made;
    OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxTexture, picture, "map", config);
    making = nullptr;
    // When all is made it renames a file, which was never there: what counts is whether there are bytes.
    const std::string problem = OIIO::geterror();
    if (made.bytes.empty()) made.problem = problem.empty() ? "cannot be made" : problem;
    return made;
}

MapBytes tiff_bytes(const OIIO::ImageSpec& spec, const std::vector<float>& pixels) {
    MapBytes made;
    OIIO::Filesystem::IOVecOutput memory;
    const auto out = OIIO::ImageOutput::create("tiff");
    const bool good = out && out->set_ioproxy(&memory) && out->open("map", spec) &&
                      out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && out->close();
    if (good)
        made.bytes = memory.buffer();
    else
        made.problem = out ? out->geterror() : OIIO::geterror();
    return made;
}

}  // namespace trapeze
