#include "pipeline/study/scenes/scene_parts.h"

#include <numeric>

#include <fmt/format.h>

namespace trapeze::scenes {

namespace {

constexpr double kBladeAngle = 12;  ///< degrees

void write_frame(RibWriter& rib, const Shot& shot, const SceneParameters& p) {
    for (const std::string& line : shot.comments) rib.comment(line);
    std::string command = fmt::format(
        "Written by: trapeze scene {} --scale {:g} --motion {:g} --defocus {:g} --shading-factor {:g} -r {}x{}",
        shot.name, p.scale, p.motion, p.defocus, p.shading_rate, p.width, p.height);
    if (p.time > 0) command += fmt::format(" --time {:g}", p.time);
    rib.comment(command);
    rib.blank_line();
    rib.request("Display", shot.name + ".exr", "openexr", "rgba");
    rib.request("Format", p.width, p.height, 1);
    rib.request("PixelSamples", 8, 8);
    rib.request("PixelFilter", "gaussian", 2, 2);
    if (shot.most_layers > 0) rib.request("Hider", "hidden", "int maxvpdepth", Integers{shot.most_layers});
    if (shot.blades > 0)
        rib.request("Hider", "hidden", "float[4] aperture",
                    Numbers{static_cast<double>(shot.blades), kBladeAngle, 0, 0});
    if (shot.glow > 0)
        rib.request("Imager", "glow", "float amount", Numbers{shot.glow}, "float size", Numbers{.015},
                    "float threshold", Numbers{1});
    rib.request("Projection", "perspective", "fov", Numbers{shot.fov});
    rib.request("Clipping", .05, 10000);
    if (p.defocus > 0)
        rib.request("DepthOfField", shot.f_stop / p.defocus, shot.focal_length, shot.focal_distance);
    if (p.motion > 0) rib.request("Shutter", 0, 1);
    rib.request("ShadingRate", shot.shading_rate * p.shading_rate);
    rib.request("ShadingInterpolation", "smooth");
    if (shot.pitch != 0) rib.request("Rotate", -shot.pitch, 1, 0, 0);
    if (shot.eye != V3d(0)) rib.request("Translate", -shot.eye.x, -shot.eye.y, -shot.eye.z);
    rib.blank_line();
}

}  // namespace

std::string scene_of(const Shot& shot, void (*write_world)(RibWriter&, const SceneParameters&),
                     const SceneParameters& parameters) {
    RibWriter rib;
    write_frame(rib, shot, parameters);
    {
        const auto world = rib.block("World");
        write_world(rib, parameters);
    }
    return rib.text();
}

void write_moving(RibWriter& rib, std::string_view request, const Numbers& middle, const Numbers& change,
                  const SceneParameters& p) {
    Numbers open = middle, close = middle;
    for (size_t i = 0; i < middle.size(); ++i) {
        open[i] -= .5 * p.motion * change[i];
        close[i] += .5 * p.motion * change[i];
    }
    rib.moving(request, open, close);
}

void MovingQuads::add(const std::array<V3d, 4>& at_opening, const std::array<V3d, 4>& at_closing,
                      const V3d& color) {
    open.insert(open.end(), at_opening.begin(), at_opening.end());
    close.insert(close.end(), at_closing.begin(), at_closing.end());
    colors.insert(colors.end(), 4, color);
}

void MovingQuads::write(RibWriter& rib, const SceneParameters& parameters) const {
    Integers vertices(open.size());
    std::iota(vertices.begin(), vertices.end(), 0);
    const auto write_at = [&](const std::vector<V3d>& places) {
        // Rounded corners are not quite in a plane: polygons would become triangles.
        rib.request("SubdivisionMesh", "bilinear", Integers(vertices.size() / 4, 4), vertices, Words{},
                    Integers{}, Integers{}, Numbers{}, "P", flattened(places), "varying color Cs",
                    flattened(colors));
    };
    if (!(parameters.motion > 0)) return write_at(open);
    rib.request("MotionBegin", Integers{0, 1});
    write_at(open);
    write_at(close);
    rib.request("MotionEnd");
}

void write_bilinear(RibWriter& rib, const V3d (&corners)[4]) {
    rib.request("Patch", "bilinear", "P", flattened(corners));
}

}  // namespace trapeze::scenes
