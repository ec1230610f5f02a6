/// Lookups of colours: by place in a picture, and by direction.
#include <algorithm>
#include <numbers>

#include "core/portable_math.h"
#include "shade/maps/map_lanes.h"
#include "shade/maps/openimageio/map_cache.h"

namespace trapeze {
namespace {

using map_lanes::value;

/// Bounds of the coordinates and regions that OpenImageIO is given: its whole numbers, and squares of its
/// floats, overflow beyond.
constexpr float kMostRegion = 1 << 10;  ///< in widths of the picture, that a lookup is filtered over
constexpr float kFarthest = 1 << 10;    ///< in widths of the picture, that a coordinate is from 0

OIIO::TextureOpt::Wrap wrap_of(MapOptions::Wrap asked, OIIO::TextureOpt::Wrap of_picture) {
    switch (asked) {
        case MapOptions::Wrap::Black:
            return OIIO::TextureOpt::WrapBlack;
        case MapOptions::Wrap::Periodic:
            return OIIO::TextureOpt::WrapPeriodic;
        case MapOptions::Wrap::Clamp:
            return OIIO::TextureOpt::WrapClamp;
        case MapOptions::Wrap::Mirror:
            return OIIO::TextureOpt::WrapMirror;
        case MapOptions::Wrap::OfPicture:
            break;
    }
    return of_picture;
}

bool folds(bool must_fold, OIIO::TextureOpt::Wrap wrap) {
    return must_fold && wrap == OIIO::TextureOpt::WrapPeriodic;
}

/// The most that a filtered region is longer than wide; longer regions are made wider instead. OpenImageIO
/// looks at about twice as many places along it, and floors far away have nearly all such regions; with 32
/// they come no nearer to the truth.
constexpr int kLongestRegion = 16;

OIIO::TextureOpt lookup_options(const CachedMap& picture, const MapOptions& options) {
    OIIO::TextureOpt made;
    made.anisotropic = kLongestRegion;
    made.swrap = wrap_of(options.swrap, picture.swrap), made.twrap = wrap_of(options.twrap, picture.twrap);
    if (folds(picture.s_folds, made.swrap)) made.swrap = OIIO::TextureOpt::WrapBlack;
    if (folds(picture.t_folds, made.twrap)) made.twrap = OIIO::TextureOpt::WrapBlack;
    if (!options.lerp) made.mipmode = OIIO::TextureOpt::MipModeOneLevel;
    if (options.filter == MapOptions::Filter::Bilinear) made.interpmode = OIIO::TextureOpt::InterpBilinear;
    if (options.filter == MapOptions::Filter::Nearest) made.interpmode = OIIO::TextureOpt::InterpClosest;
    return made;
}

/// How many of the `wanted` channels, from `first` on, a picture of so many channels has.
int present_channels(int channels, float first, int wanted) {
    if (!(first < static_cast<float>(channels))) return 0;
    return std::min(channels - static_cast<int>(std::max(first, 0.0f)), wanted);
}

/// A coordinate within bounds. Where the picture repeats, the same place near 0; else what is very far away
/// counts as kFarthest.
float coordinate(float at, OIIO::TextureOpt::Wrap wrap) {
    if (std::fabs(at) <= kFarthest) return at;
    if (wrap == OIIO::TextureOpt::WrapPeriodic) return at - std::floor(at);
    if (wrap == OIIO::TextureOpt::WrapMirror) return at - 2 * std::floor(at / 2);
    return std::clamp(at, -kFarthest, kFarthest);
}

float within(float change, float most) {
    return std::clamp(change, -most, most);
}

V3f within(const V3f& change, float most) {
    return {within(change.x, most), within(change.y, most), within(change.z, most)};
}

/// The sides of the region that a lookup is filtered over, in texture coordinates.
struct Region {
    float dsdu, dtdu, dsdv, dtdv;
};

/// Gives a region some area. OpenImageIO ends the program where a blurred region has next to no area in the
/// file's pixels, as where t is a function of s. The width given is less than what OpenImageIO widens regions
/// to, so that it changes nothing else. `s_scale`, `t_scale`: the picture over what the file has of it.
Region with_area(const Region& r, double s_scale, double t_scale) {
    constexpr double kLeast = 1.0 / 64;
    const double su = s_scale * r.dsdu, tu = t_scale * r.dtdu, sv = s_scale * r.dsdv, tv = t_scale * r.dtdv;
    const double A = tu * tu + tv * tv, B = su * tu + sv * tv, C = su * su + sv * sv;
    const double root = portable::hypot(A - C, 2 * B), longest = (A + C + root) / 2,
                 least = (A + C - root) / 2;
    if (least > longest * kLeast * kLeast) return r;
    const bool is_along_u = portable::hypot(su, tu) >= portable::hypot(sv, tv);
    const double s = is_along_u ? su : sv, t = is_along_u ? tu : tv, length = portable::hypot(s, t);
    if (!(length > 0)) return r;
    const double scale = std::sqrt(longest) / length, across = scale * kLeast;
    return {static_cast<float>(s * scale / s_scale), static_cast<float>(t * scale / t_scale),
            static_cast<float>(-t * across / s_scale), static_cast<float>(s * across / t_scale)};
}

}  // namespace

template <class LookUp>
void OpenImageIoCache::each_lane(const CachedMap& map, const MapOptions& options, const Lanes& lanes,
                                 std::span<const Plane> out, const ReadFailed& failed, LookUp&& look_up) {
    const int wanted = static_cast<int>(std::min<size_t>(out.size(), 3));
    const ThreadState thread(*this);
    const OIIO::TextureOpt for_all = lookup_options(map, options);
    OIIO::TextureOpt made = for_all;
    int present = 0;
    float fill = 0;
    const auto set_for_lane = [&](size_t i) {
        const float first = options.first_channel.at(i);
        present = present_channels(map.facts.channels, first, wanted);
        fill = options.fill.at(i);
        made.firstchannel = static_cast<int>(std::clamp(first, 0.0f, static_cast<float>(map.facts.channels)));
        made.sblur = std::clamp(options.sblur.at(i), 0.0f, kMostRegion);
        made.tblur = std::clamp(options.tblur.at(i), 0.0f, kMostRegion);
    };
    const bool lanes_differ = options.first_channel.varies() || options.fill.varies() ||
                              options.sblur.varies() || options.tblur.varies();
    if (!lanes_differ) set_for_lane(0);
    for (size_t i = 0; i < lanes.count; ++i) {
        if (!map_lanes::is_on(lanes, i)) continue;
        if (lanes_differ) set_for_lane(i);
        float color[3] = {0, 0, 0};
        if (present) {
            made.swrap = for_all.swrap, made.twrap = for_all.twrap;  // which OpenImageIO changes
            if (!look_up(made, thread.get(), i, present, color)) {
                failed(system_->geterror());
                std::fill(color, color + present, 0.0f);
            }
        }
        for (int k = 0; k < wanted; ++k) out[k][i] = k < present ? color[k] : fill;
    }
    for (const Plane& plane : out) map_lanes::pad(lanes, plane);
}

void OpenImageIoCache::texture(const OpenMap& open, const TextureLookup& at, const MapOptions& options,
                               Lanes lanes, std::span<const Plane> out, const ReadFailed& failed) {
    const auto& map = static_cast<const CachedMap&>(open);
    const bool s_folded = folds(map.s_folds, wrap_of(options.swrap, map.swrap));
    const bool t_folded = folds(map.t_folds, wrap_of(options.twrap, map.twrap));
    each_lane(
        map, options, lanes, out, failed,
        [&](OIIO::TextureOpt& made, OIIO::TextureSystem::Perthread* thread, size_t i, int channels,
            float* color) {
            const float swidth = std::max(options.swidth.at(i), 0.0f);
            const float twidth = std::max(options.twidth.at(i), 0.0f);
            const auto s_change = [&](ConstPlane d) { return within(value(d, i) * swidth, kMostRegion); };
            const auto t_change = [&](ConstPlane d) { return within(value(d, i) * twidth, kMostRegion); };
            Region region{s_change(at.dsdu), t_change(at.dtdu), s_change(at.dsdv), t_change(at.dtdv)};
            if (made.sblur + made.tblur > 0) region = with_area(region, map.s_scale, map.t_scale);
            const float s = value(at.s, i), t = value(at.t, i);
            return system_->texture(map.handle, thread, made,
                                    s_folded ? s - std::floor(s) : coordinate(s, made.swrap),
                                    t_folded ? t - std::floor(t) : coordinate(t, made.twrap), region.dsdu,
                                    region.dtdu, region.dsdv, region.dtdv, channels, color);
        });
}

void OpenImageIoCache::environment(const OpenMap& open, const EnvironmentLookup& at,
                                   const MapOptions& options, Lanes lanes, std::span<const Plane> out,
                                   const ReadFailed& failed) {
    const auto& map = static_cast<const CachedMap&>(open);
    each_lane(map, options, lanes, out, failed,
              [&](OIIO::TextureOpt& made, OIIO::TextureSystem::Perthread* thread, size_t i, int channels,
                  float* color) {
                  V3f R = value(at.R, i), dRdu = value(at.dRdu, i), dRdv = value(at.dRdv, i);
                  const float length = R.length();
                  if (!(length > 0)) return true;
                  R /= length;
                  made.swidth = std::clamp(options.swidth.at(i), 0.0f, kMostRegion);
                  made.twidth = std::clamp(options.twidth.at(i), 0.0f, kMostRegion);
                  // Blur is a part of the picture's height, OpenImageIO's is an angle.
                  made.sblur = std::clamp(options.sblur.at(i), 0.0f, 1.0f) * std::numbers::pi_v<float>;
                  made.tblur = std::clamp(options.tblur.at(i), 0.0f, 1.0f) * std::numbers::pi_v<float>;
                  dRdu = within(dRdu / length, kMostRegion), dRdv = within(dRdv / length, kMostRegion);
                  // OpenImageIO has longitude 0 in the middle.
                  if (!map.y_up)
                      for (V3f* d : {&R, &dRdu, &dRdv}) d->x = -d->x, d->y = -d->y;
                  return system_->environment(map.handle, thread, made, R, dRdu, dRdv, channels, color);
              });
}

}  // namespace trapeze
