/// An image reader for texture caches that wraps OpenImageIO's own readers and hands pixels of 8 and 16 bits
/// that are encoded by the sRGB curve on as linear halves and floats, so that mip levels are made, and
/// lookups filtered, in linear light. Alpha is not encoded; colours that are not multiplied by it are, in
/// linear light.
#pragma once

#include <vector>

#include "core/colors/transfer.h"
#include "shade/maps/openimageio/wrapping_image_input.h"

namespace trapeze {

/// Whether pixels of such a file are taken to be encoded by the sRGB curve. Auto: 8 bits and three colours or
/// more, unless the file's metadata names another space.
bool is_srgb_encoded(const OIIO::ImageSpec& spec, Transfer transfer);

class LinearImageInput : public WrappingImageInput {
  public:
    /// The name by which a cache knows the decoded pixels of a file, beside the pixels as they are.
    static std::string decoded_name(const std::string& file);

    /// Makes a reader, as OpenImageIO's caches want it. It opens files by their own or by their decoded
    /// names.
    static OIIO::ImageInput* create() { return new LinearImageInput; }

    const char* format_name() const override { return "linear"; }
    using WrappingImageInput::open;
    bool open(const std::string& name, OIIO::ImageSpec& new_spec, const OIIO::ImageSpec& config) override;

  private:
    void take_spec() override;
    bool read_row(int y, int z, size_t pixels, void* data) override;
    bool read_square(int x, int y, int z, size_t pixels, void* data) override;
    /// Converts pixels as they are read from the wrapped file and stores them at `data`.
    template <class Stored>
    void deliver(const std::vector<unsigned char>& pixels, void* data) const;
    template <class Read>
    bool read(size_t pixels, void* data, Read&& read_native);

    OIIO::TypeDesc stored_;  ///< of the file's numbers
    bool decodes_ = false, multiplies_ = false;
};

}  // namespace trapeze
