/// The calls with "...", up to RI_NULL: options, attributes, shaders, maps. The V forms do the work.
#include <cstdarg>

#include "pipeline/ri/pairs.h"

using trapeze::ri::PairList;

RtVoid RiProjection(RtToken name, ...) {
    va_list rest;
    va_start(rest, name);
    PairList pairs(rest);
    va_end(rest);
    RiProjectionV(name, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiImager(RtToken name, ...) {
    va_list rest;
    va_start(rest, name);
    PairList pairs(rest);
    va_end(rest);
    RiImagerV(name, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiDisplay(RtToken name, RtToken type, RtToken mode, ...) {
    va_list rest;
    va_start(rest, mode);
    PairList pairs(rest);
    va_end(rest);
    RiDisplayV(name, type, mode, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiDisplayChannel(RtToken channel, ...) {
    va_list rest;
    va_start(rest, channel);
    PairList pairs(rest);
    va_end(rest);
    RiDisplayChannelV(channel, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiHider(RtToken type, ...) {
    va_list rest;
    va_start(rest, type);
    PairList pairs(rest);
    va_end(rest);
    RiHiderV(type, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiOption(RtToken name, ...) {
    va_list rest;
    va_start(rest, name);
    PairList pairs(rest);
    va_end(rest);
    RiOptionV(name, pairs.count(), pairs.tokens(), pairs.values());
}

RtLightHandle RiLightSource(RtToken name, ...) {
    va_list rest;
    va_start(rest, name);
    PairList pairs(rest);
    va_end(rest);
    return RiLightSourceV(name, pairs.count(), pairs.tokens(), pairs.values());
}

RtLightHandle RiAreaLightSource(RtToken name, ...) {
    va_list rest;
    va_start(rest, name);
    PairList pairs(rest);
    va_end(rest);
    return RiAreaLightSourceV(name, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiSurface(RtToken name, ...) {
    va_list rest;
    va_start(rest, name);
    PairList pairs(rest);
    va_end(rest);
    RiSurfaceV(name, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiDisplacement(RtToken name, ...) {
    va_list rest;
    va_start(rest, name);
    PairList pairs(rest);
    va_end(rest);
    RiDisplacementV(name, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiAtmosphere(RtToken name, ...) {
    va_list rest;
    va_start(rest, name);
    PairList pairs(rest);
    va_end(rest);
    RiAtmosphereV(name, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiInterior(RtToken name, ...) {
    va_list rest;
    va_start(rest, name);
    PairList pairs(rest);
    va_end(rest);
    RiInteriorV(name, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiExterior(RtToken name, ...) {
    va_list rest;
    va_start(rest, name);
    PairList pairs(rest);
    va_end(rest);
    RiExteriorV(name, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiAttribute(RtToken name, ...) {
    va_list rest;
    va_start(rest, name);
    PairList pairs(rest);
    va_end(rest);
    RiAttributeV(name, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiDeformation(RtToken name, ...) {
    va_list rest;
    va_start(rest, name);
    PairList pairs(rest);
    va_end(rest);
    RiDeformationV(name, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiMakeTexture(RtString picture, RtString texture, RtToken swrap, RtToken twrap, RtFilterFunc filter,
                     RtFloat swidth, RtFloat twidth, ...) {
    va_list rest;
    va_start(rest, twidth);
    PairList pairs(rest);
    va_end(rest);
    RiMakeTextureV(picture, texture, swrap, twrap, filter, swidth, twidth, pairs.count(), pairs.tokens(),
                   pairs.values());
}

RtVoid RiMakeBump(RtString picture, RtString texture, RtToken swrap, RtToken twrap, RtFilterFunc filter,
                  RtFloat swidth, RtFloat twidth, ...) {
    va_list rest;
    va_start(rest, twidth);
    PairList pairs(rest);
    va_end(rest);
    RiMakeBumpV(picture, texture, swrap, twrap, filter, swidth, twidth, pairs.count(), pairs.tokens(),
                pairs.values());
}

RtVoid RiMakeLatLongEnvironment(RtString picture, RtString texture, RtFilterFunc filter, RtFloat swidth,
                                RtFloat twidth, ...) {
    va_list rest;
    va_start(rest, twidth);
    PairList pairs(rest);
    va_end(rest);
    RiMakeLatLongEnvironmentV(picture, texture, filter, swidth, twidth, pairs.count(), pairs.tokens(),
                              pairs.values());
}

RtVoid RiMakeCubeFaceEnvironment(RtString px, RtString nx, RtString py, RtString ny, RtString pz, RtString nz,
                                 RtString texture, RtFloat fov, RtFilterFunc filter, RtFloat swidth,
                                 RtFloat twidth, ...) {
    va_list rest;
    va_start(rest, twidth);
    PairList pairs(rest);
    va_end(rest);
    RiMakeCubeFaceEnvironmentV(px, nx, py, ny, pz, nz, texture, fov, filter, swidth, twidth, pairs.count(),
                               pairs.tokens(), pairs.values());
}

RtVoid RiMakeShadow(RtString picture, RtString texture, ...) {
    va_list rest;
    va_start(rest, texture);
    PairList pairs(rest);
    va_end(rest);
    RiMakeShadowV(picture, texture, pairs.count(), pairs.tokens(), pairs.values());
}

RtVoid RiReadArchive(RtToken name, RtArchiveCallback callback, ...) {
    va_list rest;
    va_start(rest, callback);
    PairList pairs(rest);
    va_end(rest);
    RiReadArchiveV(name, callback, pairs.count(), pairs.tokens(), pairs.values());
}
