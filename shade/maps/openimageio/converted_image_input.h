/// An image reader for texture caches that wraps OpenImageIO's own readers and hands pixels on as halves and
/// floats in the working space of colour management, so that mip levels are made, and lookups filtered,
/// there. Colours that are not multiplied by alpha are after they are converted; others are divided by it for
/// that.
#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <vector>

#include "core/color_management.h"

namespace trapeze {

class ConvertedImageInput : public OIIO::ImageInput {
  public:
    /// The name by which a cache knows a file's pixels from a colour space, beside the pixels as they are.
    static std::string converted_name(const std::string& file, const std::string& space);
    /// What open() must be given: the transform, which outlives the reader, and the file's own name.
    static OIIO::ImageSpec config_of(const ColorTransform& transform, const std::string& file);

    /// Makes a reader, as OpenImageIO's caches want it.
    static OIIO::ImageInput* create() { return new ConvertedImageInput; }

    const char* format_name() const override { return "converted"; }
    bool open(const std::string& name, OIIO::ImageSpec& new_spec) override;
    bool open(const std::string& name, OIIO::ImageSpec& new_spec, const OIIO::ImageSpec& config) override;
    bool close() override;
    int current_subimage() const override { return inner_ ? inner_->current_subimage() : 0; }
    int current_miplevel() const override { return inner_ ? inner_->current_miplevel() : 0; }
    bool seek_subimage(int subimage, int miplevel) override;
    bool read_native_scanline(int subimage, int miplevel, int y, int z, void* data) override;
    bool read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data) override;

  private:
    void take_spec();
    void convert(float* pixels, size_t count) const;
    template <class Read>
    bool read(size_t pixels, void* data, Read&& read_floats);
    bool failed();

    const ColorTransform* transform_ = nullptr;
    std::unique_ptr<OIIO::ImageInput> inner_;
    bool is_unassociated_ = false;
    std::vector<int> colors_;  ///< channels that are colours: at most the first three
};

}  // namespace trapeze
