#include "shade/maps/openimageio/linear_image_input.h"

#include <Imath/half.h>

#include <cmath>
#include <limits>

#include "core/portable_math.h"

namespace trapeze {
namespace {

/// What follows a file's name in the cache for its decoded pixels.
constexpr std::string_view kDecoded = " (decoded from sRGB)";

/// Linear light from a value encoded by the sRGB curve (IEC 61966-2-1).
float linear_from_srgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : portable::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

template <class Stored>
std::vector<float> decoding_table() {
    constexpr size_t kLargest = std::numeric_limits<Stored>::max();
    std::vector<float> table(kLargest + 1);
    for (size_t i = 0; i <= kLargest; ++i)
        table[i] = linear_from_srgb(static_cast<float>(i) / static_cast<float>(kLargest));
    return table;
}

/// Whether all channels are whole numbers of 8 or of 16 bits.
bool is_whole(const OIIO::ImageSpec& spec) {
    return (spec.format == OIIO::TypeDesc::UINT8 || spec.format == OIIO::TypeDesc::UINT16) &&
           spec.channelformats.empty();
}

}  // namespace

bool is_srgb_encoded(const OIIO::ImageSpec& spec, Transfer transfer) {
    if (transfer == Transfer::Linear || !is_whole(spec)) return false;
    if (transfer == Transfer::Srgb) return true;
    const int colors = spec.nchannels - (spec.alpha_channel >= 0 ? 1 : 0);
    return spec.format == OIIO::TypeDesc::UINT8 && colors >= 3 &&
           OIIO::Strutil::iequals(spec.get_string_attribute("oiio:ColorSpace", "sRGB"), "sRGB");
}

std::string LinearImageInput::decoded_name(const std::string& file) {
    return file + std::string(kDecoded);
}

bool LinearImageInput::open(const std::string& name, OIIO::ImageSpec& new_spec,
                            const OIIO::ImageSpec& config) {
    const bool decoded = name.ends_with(kDecoded);
    return open_inner(decoded ? name.substr(0, name.size() - kDecoded.size()) : name, config, new_spec);
}

void LinearImageInput::take_spec() {
    m_spec = inner_->spec();
    stored_ = m_spec.format;
    decodes_ = is_whole(m_spec);
    if (!decodes_) return;
    multiplies_ = m_spec.alpha_channel >= 0 && m_spec.get_int_attribute("oiio:UnassociatedAlpha") != 0;
    m_spec.erase_attribute("oiio:UnassociatedAlpha");
    m_spec.set_format(stored_ == OIIO::TypeDesc::UINT8 ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
    m_spec.attribute("oiio:ColorSpace", "Linear");
}

template <class Stored>
void LinearImageInput::deliver(const std::vector<unsigned char>& pixels, void* data) const {
    static const std::vector<float> kTable = decoding_table<Stored>();
    using Value = std::conditional_t<sizeof(Stored) == 1, Imath::half, float>;
    const auto* in = reinterpret_cast<const Stored*>(pixels.data());
    auto* out = static_cast<Value*>(data);
    const int channels = m_spec.nchannels, alpha_channel = m_spec.alpha_channel;
    const size_t count = pixels.size() / sizeof(Stored) / static_cast<size_t>(channels);
    for (size_t i = 0; i < count; ++i, in += channels, out += channels) {
        const float alpha = alpha_channel < 0 ? 1.0f
                                              : static_cast<float>(in[alpha_channel]) /
                                                    static_cast<float>(std::numeric_limits<Stored>::max());
        for (int c = 0; c < channels; ++c)
            out[c] = Value(c == alpha_channel ? alpha : kTable[in[c]] * (multiplies_ ? alpha : 1.0f));
    }
}

/// Delivers pixels to `data`. `read_native` reads so many from the wrapped file into its argument.
template <class Read>
bool LinearImageInput::read(size_t pixels, void* data, Read&& read_native) {
    if (!decodes_) return read_native(data);
    std::vector<unsigned char> stored(pixels * m_spec.nchannels * stored_.size());
    if (!read_native(stored.data())) return false;
    if (stored_ == OIIO::TypeDesc::UINT8)
        deliver<uint8_t>(stored, data);
    else
        deliver<uint16_t>(stored, data);
    return true;
}

bool LinearImageInput::read_row(int y, int z, size_t pixels, void* data) {
    return read(pixels, data, [&](void* to) {
        return inner_->read_native_scanline(current_subimage(), current_miplevel(), y, z, to);
    });
}

bool LinearImageInput::read_square(int x, int y, int z, size_t pixels, void* data) {
    return read(pixels, data, [&](void* to) {
        return inner_->read_native_tile(current_subimage(), current_miplevel(), x, y, z, to);
    });
}

}  // namespace trapeze
