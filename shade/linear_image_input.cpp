#include "shade/linear_image_input.h"

#include <Imath/half.h>

#include <array>
#include <cmath>
#include <cstring>

namespace trapeze {
namespace {

/// IEC 61966-2-1.
float linear_from_srgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

std::array<Imath::half, 256> byte_table(bool srgb) {
    std::array<Imath::half, 256> table;
    for (int i = 0; i < 256; ++i) {
        const float value = static_cast<float>(i) / 255.0f;
        table[i] = Imath::half(srgb ? linear_from_srgb(value) : value);
    }
    return table;
}

bool is_srgb(const OIIO::ImageSpec& spec) {
    if (spec.format != OIIO::TypeDesc::UINT8 || !spec.channelformats.empty()) return false;
    const std::string space = spec.get_string_attribute("oiio:ColorSpace", "sRGB");
    return OIIO::Strutil::iequals(space, "sRGB");
}

}  // namespace

bool LinearImageInput::open(const std::string& name, OIIO::ImageSpec& new_spec) {
    return opened(OIIO::ImageInput::open(name), new_spec);
}

bool LinearImageInput::open(const std::string& name, OIIO::ImageSpec& new_spec,
                            const OIIO::ImageSpec& config) {
    return opened(OIIO::ImageInput::open(name, &config), new_spec);
}

bool LinearImageInput::opened(std::unique_ptr<OIIO::ImageInput> inner, OIIO::ImageSpec& new_spec) {
    inner_ = std::move(inner);
    if (!inner_) {
        errorfmt("{}", OIIO::geterror());
        return false;
    }
    take_spec();
    new_spec = m_spec;
    return true;
}

void LinearImageInput::take_spec() {
    m_spec = inner_->spec();
    is_srgb_ = is_srgb(m_spec);
    if (is_srgb_) {
        m_spec.set_format(OIIO::TypeDesc::HALF);
        m_spec.attribute("oiio:ColorSpace", "Linear");
    }
}

bool LinearImageInput::close() {
    const bool good = !inner_ || inner_->close();
    inner_.reset();
    return good;
}

bool LinearImageInput::seek_subimage(int subimage, int miplevel) {
    if (!inner_ || !inner_->seek_subimage(subimage, miplevel)) return false;
    take_spec();
    return true;
}

bool LinearImageInput::failed() {
    errorfmt("{}", inner_->geterror());
    return false;
}

void LinearImageInput::deliver(const std::vector<unsigned char>& pixels, void* data) const {
    static const std::array<Imath::half, 256> kColor = byte_table(true), kAlpha = byte_table(false);
    auto* out = static_cast<Imath::half*>(data);
    for (size_t i = 0; i < pixels.size(); ++i) {
        const bool alpha = static_cast<int>(i % m_spec.nchannels) == m_spec.alpha_channel;
        out[i] = (alpha ? kAlpha : kColor)[pixels[i]];
    }
}

bool LinearImageInput::read_native_scanline(int subimage, int miplevel, int y, int z, void* data) {
    if (!inner_) return false;
    lock_guard lock(*this);
    if (!seek_subimage(subimage, miplevel)) return failed();
    if (!is_srgb_) return inner_->read_native_scanline(subimage, miplevel, y, z, data) || failed();
    std::vector<unsigned char> pixels(static_cast<size_t>(m_spec.width) * m_spec.nchannels);
    if (!inner_->read_native_scanline(subimage, miplevel, y, z, pixels.data())) return failed();
    deliver(pixels, data);
    return true;
}

bool LinearImageInput::read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data) {
    if (!inner_) return false;
    lock_guard lock(*this);
    if (!seek_subimage(subimage, miplevel)) return failed();
    if (!is_srgb_) return inner_->read_native_tile(subimage, miplevel, x, y, z, data) || failed();
    std::vector<unsigned char> pixels(static_cast<size_t>(m_spec.tile_pixels()) * m_spec.nchannels);
    if (!inner_->read_native_tile(subimage, miplevel, x, y, z, pixels.data())) return failed();
    deliver(pixels, data);
    return true;
}

}  // namespace trapeze
