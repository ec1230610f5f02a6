#include "shade/rays/sky_in.h"

#include <fmt/format.h>

#include <optional>

namespace trapeze {

std::vector<V3f> sky_in(vm::Run& run, const vm::Step& step, std::string_view map, const std::string& space,
                        std::vector<V3f> directions, std::span<const float> widths) {
    std::vector<V3f> colors(directions.size(), V3f(0, 0, 0));
    const vm::Context& context = run.context();
    if (!context.maps || map.empty()) return colors;
    if (!space.empty() && context.spaces) {
        if (const std::optional<M44f> to = context.spaces->matrix("current", space))
            for (V3f& direction : directions) to->multDirMatrix(V3f(direction), direction);
        else
            run.warn(step, fmt::format("\"environmentspace\": there is no coordinate system \"{}\"", space),
                     fmt::format("rsl-environment-space {}", space));
    }
    context.maps->sky(map, step.at, directions, widths, colors);
    return colors;
}

}  // namespace trapeze
