/// Lookups of colours: by place in a picture, and by direction.
#include <algorithm>

#include "shade/textures_impl.h"

namespace trapeze {
namespace {

using map_lanes::value;

constexpr int kMostChannels = 1 << 10;

OIIO::TextureOpt lookup_options(const Textures::Picture& picture, const MapOptions& options) {
    OIIO::TextureOpt made;
    made.swrap = picture.swrap, made.twrap = picture.twrap;
    made.firstchannel = std::clamp(options.first_channel, 0, kMostChannels);
    made.sblur = std::max(options.sblur, 0.0f), made.tblur = std::max(options.tblur, 0.0f);
    made.swidth = std::max(options.swidth, 0.0f), made.twidth = std::max(options.twidth, 0.0f);
    made.fill = options.fill;
    if (!options.lerp) made.mipmode = OIIO::TextureOpt::MipModeOneLevel;
    if (options.filter == MapOptions::Filter::Bilinear) made.interpmode = OIIO::TextureOpt::InterpBilinear;
    if (options.filter == MapOptions::Filter::Nearest) made.interpmode = OIIO::TextureOpt::InterpClosest;
    return made;
}

/// In wanted lanes.
void set_all(const Lanes& lanes, std::span<const Plane> out, float value) {
    for (const Plane& plane : out) {
        for (size_t i = 0; i < lanes.count; ++i)
            if (map_lanes::is_on(lanes, i)) plane[i] = value;
        map_lanes::pad(lanes, plane);
    }
}

}  // namespace

template <class LookUp>
void Textures::Impl::each_lane(const Picture* picture, const MapOptions& options, const Lanes& lanes,
                               std::span<const Plane> out, LookUp&& look_up) {
    if (!picture) return set_all(lanes, out, options.without);
    const int channels = static_cast<int>(std::min<size_t>(out.size(), 3));
    const ThreadState thread(*this);
    OIIO::TextureOpt made = lookup_options(*picture, options);
    for (size_t i = 0; i < lanes.count; ++i) {
        if (!map_lanes::is_on(lanes, i)) continue;
        float color[3] = {0, 0, 0};
        const bool good = look_up(made, thread.get(), i, channels, color);
        if (!good) report_read_error(picture->name, picture->location, system->geterror());
        for (int k = 0; k < channels; ++k) out[k][i] = good ? color[k] : 0;
    }
    for (const Plane& plane : out) map_lanes::pad(lanes, plane);
}

void Textures::texture(const Picture* picture, const Lookup& at, const MapOptions& options, Lanes lanes,
                       std::span<const Plane> out) const {
    impl_->each_lane(picture, options, lanes, out,
                     [&](OIIO::TextureOpt& made, OIIO::TextureSystem::Perthread* thread, size_t i,
                         int channels, float* color) {
                         return impl_->system->texture(picture->handle, thread, made, value(at.s, i),
                                                       value(at.t, i), value(at.dsdu, i), value(at.dtdu, i),
                                                       value(at.dsdv, i), value(at.dtdv, i), channels, color);
                     });
}

void Textures::environment(const Picture* picture, const EnvironmentLookup& at, const MapOptions& options,
                           Lanes lanes, std::span<const Plane> out) const {
    impl_->each_lane(picture, options, lanes, out,
                     [&](OIIO::TextureOpt& made, OIIO::TextureSystem::Perthread* thread, size_t i,
                         int channels, float* color) {
                         const V3f R = value(at.R, i);
                         const float length = R.length();
                         if (!(length > 0)) return true;
                         return impl_->system->environment(picture->handle, thread, made, R / length,
                                                           value(at.dRdu, i) / length,
                                                           value(at.dRdv, i) / length, channels, color);
                     });
}

void Textures::lookup(const Picture& picture, const Lookup& at, size_t vertices, Plane3 out) const {
    const Plane planes[] = {out.x, out.y, out.z};
    texture(&picture, at, {}, {vertices, {}}, planes);
}

}  // namespace trapeze
