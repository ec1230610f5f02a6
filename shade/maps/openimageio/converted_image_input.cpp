#include "shade/maps/openimageio/converted_image_input.h"

#include <algorithm>

#include "core/half.h"

namespace trapeze {
namespace {

constexpr const char* kTransform = "trapeze:transform";
constexpr const char* kFile = "trapeze:file";

}  // namespace

std::string ConvertedImageInput::converted_name(const std::string& file, const std::string& space) {
    return file + " (converted from " + space + ")";
}

OIIO::ImageSpec ConvertedImageInput::config_of(const ColorTransform& transform, const std::string& file) {
    OIIO::ImageSpec config;
    const ColorTransform* const address = &transform;
    config.attribute(kTransform, OIIO::TypeDesc(OIIO::TypeDesc::PTR), &address);
    config.attribute(kFile, file);
    return config;
}

bool ConvertedImageInput::open(const std::string&, OIIO::ImageSpec& new_spec, const OIIO::ImageSpec& config) {
    const OIIO::ParamValue* const transform = config.find_attribute(kTransform, OIIO::TypeDesc::PTR);
    if (!transform) {
        errorfmt("has no transform");
        return false;
    }
    transform_ = *static_cast<const ColorTransform* const*>(transform->data());
    return open_inner(std::string(config.get_string_attribute(kFile)), {}, new_spec);
}

void ConvertedImageInput::take_spec() {
    m_spec = inner_->spec();
    is_unassociated_ = m_spec.alpha_channel >= 0 && m_spec.get_int_attribute("oiio:UnassociatedAlpha") != 0;
    colors_.clear();
    for (int c = 0; c < m_spec.nchannels && colors_.size() < 3; ++c)
        if (c != m_spec.alpha_channel && c != m_spec.z_channel) colors_.push_back(c);
    const bool fits_halves =
        (m_spec.format == OIIO::TypeDesc::UINT8 || m_spec.format == OIIO::TypeDesc::HALF) &&
        m_spec.channelformats.empty();
    m_spec.erase_attribute("oiio:UnassociatedAlpha");
    m_spec.channelformats.clear();
    m_spec.set_format(fits_halves ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
    m_spec.attribute("oiio:ColorSpace", "Linear");
}

/// Greys are converted as colours of three equal numbers.
void ConvertedImageInput::convert(float* pixels, size_t count) const {
    if (colors_.empty()) return;
    const auto channels = static_cast<size_t>(m_spec.nchannels);
    const auto alpha_of = [&](size_t i) {
        return m_spec.alpha_channel < 0 ? 1.0f
                                        : pixels[i * channels + static_cast<size_t>(m_spec.alpha_channel)];
    };
    const auto divisor_of = [&](size_t i) {
        const float alpha = is_unassociated_ ? 1 : alpha_of(i);
        return alpha > 0 ? alpha : 1;  // what has no alpha shines by itself
    };
    std::vector<float> rgba(4 * count, 1.0f);
    for (size_t i = 0; i < count; ++i)
        for (size_t c = 0; c < 3; ++c)
            rgba[4 * i + c] =
                pixels[i * channels + static_cast<size_t>(colors_[colors_.size() < 3 ? 0 : c])] /
                divisor_of(i);
    transform_->apply(rgba.data(), count);
    for (size_t i = 0; i < count; ++i) {
        const float factor = is_unassociated_ ? alpha_of(i) : divisor_of(i);
        for (size_t c = 0; c < (colors_.size() < 3 ? 1 : colors_.size()); ++c)
            pixels[i * channels + static_cast<size_t>(colors_[c])] = rgba[4 * i + c] * factor;
    }
}

/// Delivers pixels to `data`. `read_floats` reads so many from the wrapped file into its argument.
template <class Read>
bool ConvertedImageInput::read(size_t pixels, void* data, Read&& read_floats) {
    const size_t numbers = pixels * static_cast<size_t>(m_spec.nchannels);
    std::vector<float> values(numbers);
    if (!read_floats(values.data())) return false;
    convert(values.data(), pixels);
    if (m_spec.format == OIIO::TypeDesc::HALF)
        std::transform(values.begin(), values.end(), static_cast<Imath::half*>(data), to_half);
    else
        std::copy(values.begin(), values.end(), static_cast<float*>(data));
    return true;
}

bool ConvertedImageInput::read_row(int y, int z, size_t pixels, void* data) {
    return read(pixels, data,
                [&](float* to) { return inner_->read_scanline(y, z, OIIO::TypeDesc::FLOAT, to); });
}

bool ConvertedImageInput::read_square(int x, int y, int z, size_t pixels, void* data) {
    return read(pixels, data,
                [&](float* to) { return inner_->read_tile(x, y, z, OIIO::TypeDesc::FLOAT, to); });
}

}  // namespace trapeze
