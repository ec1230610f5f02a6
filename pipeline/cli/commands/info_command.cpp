#include <fmt/format.h>

#include <algorithm>

#include "core/scene/aperture.h"
#include "pipeline/cli/commands/cloud_info.h"
#include "pipeline/cli/commands/commands.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/interrupt.h"
#include "pipeline/cli/support/read_settings.h"
#include "pipeline/frame/cost/stopwatch.h"
#include "pipeline/rib/read_rib.h"

namespace trapeze {
namespace {

void print_world(int number, const Scene& scene) {
    const Options& o = scene.options;
    fmt::print("world {}: frame {}, {}x{} pixels, {}x{} samples, filter {} {}x{}\n", number, o.frame, o.width,
               o.height, o.samples_x, o.samples_y, o.filter.name, o.filter.width_x, o.filter.width_y);
    if (o.projection == "perspective")
        fmt::print("    perspective, fov {}", o.fov);
    else
        fmt::print("    {}", o.projection);
    if (o.f_stop < kInfinity)
        fmt::print(", f/{} lens of {} focused at {}", o.f_stop, o.focal_length, o.focal_distance);
    const Aperture aperture = aperture_of(o);
    if (o.f_stop < kInfinity && !aperture.is_disk())
        fmt::print(", {}, density {}",
                   aperture.is_round()
                       ? "round"
                       : fmt::format("{} blades, roundness {}", aperture.blades, aperture.roundness),
                   aperture.density);
    if (o.shutter_close > o.shutter_open) fmt::print(", shutter {} to {}", o.shutter_open, o.shutter_close);
    fmt::print("\n");
    for (const Display& display : o.displays)
        fmt::print("    display \"{}\" \"{}\" \"{}\"\n", display.name, display.type, display.mode);
}

void print_counts(const char* title, const std::map<std::string, uint64_t>& counts) {
    if (counts.empty()) return;
    fmt::print("{}:\n", title);
    for (const auto& [name, count] : counts) fmt::print("    {:8} {}\n", count, name);
}

}  // namespace

int info_command(const Arguments& arguments, Terminal&, Diagnostics& diagnostics) {
    const Interrupt interrupt(arguments.time_limit);
    if (!inputs_exist(arguments.inputs, diagnostics)) return kExitNoInput;
    Access access = scene_access(arguments);
    if (std::ranges::any_of(arguments.inputs, names_point_cloud))
        return cloud_info(arguments, access, diagnostics);
    ReadOptions options = read_options(arguments, access);
    options.cancelled = &interrupt.requested();
    options.keep_geometry = false;
    int worlds = 0;
    Stopwatch watch;
    const ReadSummary s = read_rib(arguments.inputs, options, diagnostics,
                                   [&](Scene&& scene) { print_world(++worlds, scene); });
    const double seconds = watch.lap();
    if (interrupt.requested()) return interrupt.exit_code();
    print_counts("primitives", s.primitives);
    print_counts("shaders", s.shaders);
    print_counts("requests not supported", s.unsupported);
    fmt::print("{} frames, {} worlds, {} lights; {} faces, {} control points, {} moving primitives\n",
               s.frames, s.worlds, s.lights, s.faces, s.points, s.moving_primitives);
    fmt::print("{} files, {:.1f} MB read in {:.3f} s\n", s.files, static_cast<double>(s.bytes) * 1e-6,
               seconds);
    return diagnostics.count(Severity::Error) > 0 ? kExitErrors : kExitOk;
}

}  // namespace trapeze
