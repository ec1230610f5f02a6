#include "shade/maps/openimageio/wrapping_image_input.h"

namespace trapeze {

bool WrappingImageInput::open_inner(const std::string& file, OIIO::ImageSpec config,
                                    OIIO::ImageSpec& new_spec) {
    config.attribute("oiio:UnassociatedAlpha", 1);
    inner_ = OIIO::ImageInput::open(file, &config);
    if (!inner_) {
        errorfmt("{}", OIIO::geterror());
        return false;
    }
    take_spec();
    new_spec = m_spec;
    return true;
}

bool WrappingImageInput::close() {
    const bool good = !inner_ || inner_->close();
    inner_.reset();
    return good;
}

bool WrappingImageInput::seek_subimage(int subimage, int miplevel) {
    if (!inner_ || !inner_->seek_subimage(subimage, miplevel)) return false;
    take_spec();
    return true;
}

bool WrappingImageInput::failed() {
    errorfmt("{}", inner_->geterror());
    return false;
}

bool WrappingImageInput::read_native_scanline(int subimage, int miplevel, int y, int z, void* data) {
    if (!inner_) return false;
    lock_guard lock(*this);
    if (!seek_subimage(subimage, miplevel)) return failed();
    return read_row(y, z, static_cast<size_t>(m_spec.width), data) || failed();
}

bool WrappingImageInput::read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data) {
    if (!inner_) return false;
    lock_guard lock(*this);
    if (!seek_subimage(subimage, miplevel)) return failed();
    return read_square(x, y, z, static_cast<size_t>(m_spec.tile_pixels()), data) || failed();
}

}  // namespace trapeze
