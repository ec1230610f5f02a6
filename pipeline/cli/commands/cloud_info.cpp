#include "pipeline/cli/commands/cloud_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/frame/frame_memory.h"
#include "shade/clouds/cloud_library.h"

namespace trapeze {
namespace {

/// What all discs have together, and the smallest and largest radius.
void print_radii(const PointCloud& cloud) {
    double area = 0;
    for (const float radius : cloud.radii) area += std::numbers::pi * static_cast<double>(radius) * radius;
    const auto [least, most] = std::ranges::minmax_element(cloud.radii);
    fmt::print("    radii {:.6g} to {:.6g}, area {:.6g}\n", *least, *most, area);
}

void print_cloud(const std::string& name, const PointCloud& cloud) {
    fmt::print("{}: {} points\n", name, cloud.size());
    if (const Box3f box = cloud.bounds(); !box.isEmpty())
        fmt::print("    bounds {:.6g} {:.6g} {:.6g} to {:.6g} {:.6g} {:.6g}\n", box.min.x, box.min.y,
                   box.min.z, box.max.x, box.max.y, box.max.z);
    if (cloud.size() > 0) print_radii(cloud);
    size_t first = 0;
    for (const CloudChannel& channel : cloud.channels) {
        const auto floats = static_cast<size_t>(floats_of(channel.type));
        double sum = 0;
        for (size_t i = first; i < cloud.values.size(); i += cloud.floats_per_point())
            for (size_t k = 0; k < floats; ++k) sum += static_cast<double>(cloud.values[i + k]);
        const double count = static_cast<double>(floats * std::max<size_t>(cloud.size(), 1));
        fmt::print("    {} {}, mean {:.6g}\n", name_of(channel.type), channel.name, sum / count);
        first += floats;
    }
}

}  // namespace

bool names_point_cloud(const std::string& input) {
    return input.ends_with(".ptc") || input.ends_with(".ply");
}

int cloud_info(const Arguments& arguments, const Access& access, Diagnostics& diagnostics) {
    for (const std::string& input : arguments.inputs) {
        std::string bytes, problem = "it cannot be read, or is too large for the memory";
        std::optional<PointCloud> cloud;
        if (access.read(input, default_memory_budget() / 4, &bytes))
            cloud = read_point_cloud(bytes, &problem);
        if (cloud)
            print_cloud(input, *cloud);
        else
            diagnostics.error({}, fmt::format("point cloud \"{}\": {}", input, problem));
    }
    return diagnostics.count(Severity::Error) > 0 ? kExitErrors : kExitOk;
}

}  // namespace trapeze
