/// MakeTexture, MakeBump, MakeLatLongEnvironment, MakeCubeFaceEnvironment, MakeShadow (RISpec 3.2, section
/// 7).
#include "pipeline/rib/map_request.h"
#include "pipeline/rib/requests/colorspaces.h"
#include "pipeline/rib/requests/request_table.h"

namespace trapeze::rib {
namespace {

using Kind = MapRequest::Kind;

/// The filter and its widths, of which there is no use. They are read all the same, since a request with too
/// few numbers is a wrong one.
void take_filter(ArgumentCursor& c, MapRequest& request) {
    request.filter = c.string("the filter");
    c.numbers(2, "the filter's widths");
}

/// Parameters end the request; "colorspace" counts among them.
void finish(MapContext& r, ArgumentCursor& c, MapRequest request) {
    ParameterList parameters = r.parameters(c, Undeclared::Guess);
    request.colorspace = colorspace_of(r.report, parameters);
    r.make_map(std::move(request));
}

/// MakeTexture and MakeBump: the wrap modes of s and t, then the filter.
void make_flat(MapContext& r, ArgumentCursor& c, Kind kind) {
    MapRequest request;
    request.kind = kind;
    request.pictures = {c.string("the picture's name")};
    request.map = c.string("the texture's name");
    request.swrap = c.string("the wrap mode of s");
    request.twrap = c.string("the wrap mode of t");
    take_filter(c, request);
    finish(r, c, std::move(request));
}

/// MakeLatLongEnvironment picture map filter swidth twidth: longitude goes along x.
void make_lat_long_environment(MapContext& r, ArgumentCursor& c) {
    MapRequest request;
    request.kind = Kind::LatLongEnvironment;
    request.pictures = {c.string("the picture's name")};
    request.map = c.string("the environment's name");
    take_filter(c, request);
    finish(r, c, std::move(request));
}

/// MakeCubeFaceEnvironment px nx py ny pz nz map fov filter swidth twidth: faces see a little more than 90
/// degrees, so that lookups can blend.
void make_cube_face_environment(MapContext& r, ArgumentCursor& c) {
    MapRequest request;
    request.kind = Kind::CubeFaceEnvironment;
    for (int i = 0; i < 6; ++i) request.pictures.push_back(c.string("the name of a face's picture"));
    request.map = c.string("the environment's name");
    request.fov = c.number("the field of view");
    if (!(request.fov >= 90 && request.fov < 180))
        throw RequestError{"the field of view must be from 90 to less than 180 degrees", {}};
    request.filter = c.string("the filter");
    if (request.filter == "black" || request.filter == "clamp" || request.filter == "periodic") {
        // Some exporters write wrap modes, as for textures; a cube has none.
        c.string("the wrap mode of t");
        request.filter = c.string("the filter");
    }
    c.numbers(2, "the filter's widths");
    finish(r, c, std::move(request));
}

/// The picture is a depth map, of which nothing is filtered.
void make_shadow(MapContext& r, ArgumentCursor& c) {
    MapRequest request;
    request.kind = Kind::Shadow;
    request.pictures = {c.string("the picture's name")};
    request.map = c.string("the shadow map's name");
    finish(r, c, std::move(request));
}

/// RISpec has them among the options: between worlds.
constexpr RequestRow kMapRequests[] = {
    {"MakeTexture", [](MapContext& r, ArgumentCursor& c) { make_flat(r, c, Kind::Texture); }},
    {"MakeBump", [](MapContext& r, ArgumentCursor& c) { make_flat(r, c, Kind::Bump); }},
    {"MakeLatLongEnvironment", make_lat_long_environment},
    {"MakeCubeFaceEnvironment", make_cube_face_environment},
    {"MakeShadow", make_shadow},
};

}  // namespace

std::span<const RequestRow> map_requests() {
    return kMapRequests;
}

}  // namespace trapeze::rib
