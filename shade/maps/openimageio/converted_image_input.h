/// An image reader for texture caches that wraps OpenImageIO's own readers and hands pixels on as halves and
/// floats in the working space of colour management, so that mip levels are made, and lookups filtered,
/// there. Colours that are not multiplied by alpha are after they are converted; others are divided by it for
/// that.
#pragma once

#include <vector>

#include "core/colors/color_management.h"
#include "shade/maps/openimageio/wrapping_image_input.h"

namespace trapeze {

class ConvertedImageInput : public WrappingImageInput {
  public:
    /// The name by which a cache knows a file's pixels from a colour space, beside the pixels as they are.
    static std::string converted_name(const std::string& file, const std::string& space);
    /// What open() must be given: the transform, which outlives the reader, and the file's own name.
    static OIIO::ImageSpec config_of(const ColorTransform& transform, const std::string& file);

    /// Makes a reader, as OpenImageIO's caches want it.
    static OIIO::ImageInput* create() { return new ConvertedImageInput; }

    const char* format_name() const override { return "converted"; }
    using WrappingImageInput::open;
    bool open(const std::string& name, OIIO::ImageSpec& new_spec, const OIIO::ImageSpec& config) override;

  private:
    void take_spec() override;
    bool read_row(int y, int z, size_t pixels, void* data) override;
    bool read_square(int x, int y, int z, size_t pixels, void* data) override;
    void convert(float* pixels, size_t count) const;
    template <class Read>
    bool read(size_t pixels, void* data, Read&& read_floats);

    const ColorTransform* transform_ = nullptr;
    bool is_unassociated_ = false;
    std::vector<int> colors_;  ///< channels that are colours: at most the first three
};

}  // namespace trapeze
