/// Arbitrary output variables: which variables of surface shaders the Displays of a scene ask for by name
/// (RISpec 3.2, section 4.1.2, Display: "varying color foo"), and where each stands among the channels that
/// grids, the film and the picture carry for them.
///
/// Output variables go through the renderer as Ci does: a micropolygon's value is its vertex 00's, or
/// interpolated when shading is smooth; a sample's layers are added up from front to back, each weighed by
/// what the layers before it let through (1 - Oi of each, by channel of a colour; the mean of the three for
/// floats, points, vectors and normals), so that a value is taken to be premultiplied as Ci is; then they are
/// filtered as colour is. A held-out (Matte) layer adds nothing and hides what is behind it; neither does a
/// layer add anything that shows nothing at all, its Ci and Oi both 0. Pixels where nothing is have 0.
/// Exposure and imager shaders leave them alone. The variable z is no such channel but the depth of the
/// picture, by the hider's depth filter.
///
/// A Display's "filter" may keep of a pixel's samples one (VariableFilter), which suits positions, names in
/// numbers and whatever else has no mean: nearest and farthest take the first layer that shows something, as
/// it is.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"

namespace trapeze {

/// The most channels that all variables of a scene together take: each of a grid's vertices has so many
/// floats.
inline constexpr int kMostAovChannels = 192;

/// One output variable's place among a grid's channels.
struct Aov {
    std::string name;
    int channels = 3;  ///< 1: a float; 3: a colour, point, vector or normal
    int offset = 0;    ///< of the first among the layout's channels
    VariableFilter filter = VariableFilter::Picture;
    bool is_color = true;  ///< of three channels: else in space, where opacity by channel means nothing

    bool is_summed() const { return filter == VariableFilter::Picture; }
    /// Whether a sample has the value of one surface, else that of all that it sees.
    bool is_of_one_surface() const {
        return filter == VariableFilter::Nearest || filter == VariableFilter::Farthest;
    }
};

/// Places of the variables asked for, each once for a number of channels and a filter, in the order of the
/// Displays.
struct AovLayout {
    std::vector<Aov> aovs;
    int channel_count = 0;

    bool empty() const { return aovs.empty(); }
    bool all_summed() const {
        return std::ranges::all_of(aovs, [](const Aov& aov) { return aov.is_summed(); });
    }
    /// The place of a variable; null when it is not there, since too many were asked for.
    const Aov* find(const DisplayVariable& variable) const&;
    const Aov* find(const DisplayVariable& variable) && = delete;
};

/// The layout that a scene's Displays ask for; it follows from them alone. What does not fit in
/// kMostAovChannels is left out.
AovLayout aov_layout(const Options& options);

/// Whether a file can have channels of a variable's name.
bool can_name_channels(std::string_view name);

/// Whether the variable is z, the depth that every picture has.
bool is_depth(const DisplayVariable& variable);

}  // namespace trapeze
