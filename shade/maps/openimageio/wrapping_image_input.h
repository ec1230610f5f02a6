/// What image readers for texture caches share that wrap OpenImageIO's own readers and hand their pixels on
/// changed: where they stand in the wrapped file, and what went wrong in it.
#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

namespace trapeze {

class WrappingImageInput : public OIIO::ImageInput {
  public:
    bool open(const std::string& name, OIIO::ImageSpec& new_spec) override {
        return open(name, new_spec, {});
    }
    bool open(const std::string& name, OIIO::ImageSpec& new_spec, const OIIO::ImageSpec& config) override = 0;
    bool close() override;
    int current_subimage() const override { return inner_ ? inner_->current_subimage() : 0; }
    int current_miplevel() const override { return inner_ ? inner_->current_miplevel() : 0; }
    bool seek_subimage(int subimage, int miplevel) override;
    bool read_native_scanline(int subimage, int miplevel, int y, int z, void* data) override;
    bool read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data) override;

  protected:
    /// Opens the wrapped file. Its colours come as they are stored: where alpha does not multiply them, that
    /// is done after they are changed, not before.
    bool open_inner(const std::string& file, OIIO::ImageSpec config, OIIO::ImageSpec& new_spec);
    bool failed();

    /// Sets m_spec, and whatever else a subimage decides, by inner_->spec().
    virtual void take_spec() = 0;
    /// Reads a row, or a tile, and stores its pixels, changed, at `data`.
    virtual bool read_row(int y, int z, size_t pixels, void* data) = 0;
    virtual bool read_square(int x, int y, int z, size_t pixels, void* data) = 0;

    std::unique_ptr<OIIO::ImageInput> inner_;
};

}  // namespace trapeze
