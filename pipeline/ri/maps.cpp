/// Texture, environment and shadow maps (RISpec 7).
#include "pipeline/ri/call.h"
#include "pipeline/ri/names.h"
#include "pipeline/ri/parameters.h"

namespace trapeze::ri {
namespace {

struct MapFilter {
    RtFilterFunc function;
    float swidth, twidth;
};

struct MapCall {
    const char *name, *request;
    std::initializer_list<RtToken> words;  ///< pictures, the map, wrap modes
    const float* fov = nullptr;
    const MapFilter* filter = nullptr;
};

void write_map(const MapCall& map, const RiArguments& arguments) {
    call(map.name, [&](Context& context) {
        context.expect_options();
        for (const RtToken word : map.words) required(word, "a name");
        const char* const filter = map.filter ? filter_name(map.filter->function) : nullptr;
        const auto parameters = checked_parameters(context, arguments, "map");
        context.writer().request(map.request);
        for (const RtToken word : map.words) context.writer().string(word);
        if (map.fov) context.writer().number(*map.fov);
        if (filter) {
            context.writer().string(filter);
            context.writer().number(map.filter->swidth), context.writer().number(map.filter->twidth);
        }
        write_parameters(context.writer(), parameters);
    });
}

}  // namespace
}  // namespace trapeze::ri

using namespace trapeze::ri;

RtVoid RiMakeTextureV(RtString picture, RtString texture, RtToken swrap, RtToken twrap, RtFilterFunc filter,
                      RtFloat swidth, RtFloat twidth, RtInt n, RtToken tokens[], RtPointer values[]) {
    const MapFilter widths{filter, swidth, twidth};
    write_map({"RiMakeTexture", "MakeTexture", {picture, texture, swrap, twrap}, nullptr, &widths},
              {n, tokens, values});
}

RtVoid RiMakeBumpV(RtString picture, RtString texture, RtToken swrap, RtToken twrap, RtFilterFunc filter,
                   RtFloat swidth, RtFloat twidth, RtInt n, RtToken tokens[], RtPointer values[]) {
    const MapFilter widths{filter, swidth, twidth};
    write_map({"RiMakeBump", "MakeBump", {picture, texture, swrap, twrap}, nullptr, &widths},
              {n, tokens, values});
}

RtVoid RiMakeLatLongEnvironmentV(RtString picture, RtString texture, RtFilterFunc filter, RtFloat swidth,
                                 RtFloat twidth, RtInt n, RtToken tokens[], RtPointer values[]) {
    const MapFilter widths{filter, swidth, twidth};
    write_map({"RiMakeLatLongEnvironment", "MakeLatLongEnvironment", {picture, texture}, nullptr, &widths},
              {n, tokens, values});
}

RtVoid RiMakeCubeFaceEnvironmentV(RtString px, RtString nx, RtString py, RtString ny, RtString pz,
                                  RtString nz, RtString texture, RtFloat fov, RtFilterFunc filter,
                                  RtFloat swidth, RtFloat twidth, RtInt n, RtToken tokens[],
                                  RtPointer values[]) {
    const MapFilter widths{filter, swidth, twidth};
    write_map({"RiMakeCubeFaceEnvironment",
               "MakeCubeFaceEnvironment",
               {px, nx, py, ny, pz, nz, texture},
               &fov,
               &widths},
              {n, tokens, values});
}

RtVoid RiMakeShadowV(RtString picture, RtString texture, RtInt n, RtToken tokens[], RtPointer values[]) {
    write_map({"RiMakeShadow", "MakeShadow", {picture, texture}}, {n, tokens, values});
}
