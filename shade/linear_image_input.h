/// An image reader for texture caches that wraps OpenImageIO's own readers and hands 8-bit sRGB pixels on as
/// linear halves, so that mip levels are made, and lookups filtered, in linear light.
#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>

namespace trapeze {

class LinearImageInput : public OIIO::ImageInput {
  public:
    /// As OpenImageIO's caches want it.
    static OIIO::ImageInput* create() { return new LinearImageInput; }

    const char* format_name() const override { return "linear"; }
    bool open(const std::string& name, OIIO::ImageSpec& new_spec) override;
    bool open(const std::string& name, OIIO::ImageSpec& new_spec, const OIIO::ImageSpec& config) override;
    bool close() override;
    int current_subimage() const override { return inner_ ? inner_->current_subimage() : 0; }
    int current_miplevel() const override { return inner_ ? inner_->current_miplevel() : 0; }
    bool seek_subimage(int subimage, int miplevel) override;
    bool read_native_scanline(int subimage, int miplevel, int y, int z, void* data) override;
    bool read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data) override;

  private:
    bool opened(std::unique_ptr<OIIO::ImageInput> inner, OIIO::ImageSpec& new_spec);
    void take_spec();
    /// After a read of the wrapped file: pixels as they were read, bytes where is_srgb_.
    void deliver(const std::vector<unsigned char>& pixels, void* data) const;
    bool failed();

    std::unique_ptr<OIIO::ImageInput> inner_;
    bool is_srgb_ = false;
};

}  // namespace trapeze
