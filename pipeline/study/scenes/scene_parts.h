/// What the scenes' generators share: chance by index, the frame's requests, the table's functions.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/random.h"
#include "pipeline/study/scenes/rib_writer.h"
#include "pipeline/study/scenes/scenes.h"

namespace trapeze::scenes {

inline constexpr double kPi = 3.14159265358979323846;

/// Random numbers of one thing, by its kind and index: what one thing draws changes nothing for another, so
/// that more hairs or flowers leave the others as they are.
class Chance {
  public:
    Chance(uint32_t kind, uint32_t index) : seed_(hash(kind, index)) {}

    /// Uniform in [0, 1).
    double unit() { return static_cast<double>(unit_float(hash(seed_, count_++))); }
    double between(double low, double high) { return low + (high - low) * unit(); }
    /// A unit vector, uniform on the sphere.
    V3d direction() {
        const double z = between(-1, 1), angle = between(0, 2 * kPi), r = std::sqrt(1 - z * z);
        return {r * std::cos(angle), r * std::sin(angle), z};
    }

  private:
    uint32_t seed_, count_ = 0;
};

/// The camera of a scene and its quality. Lengths are in the scene's units.
struct Shot {
    std::string name;
    std::vector<std::string> comments;  ///< lines for the reader of the file
    V3d eye{0, 0, 0};
    double pitch = 0;  ///< degrees, downwards
    double fov = 30;
    /// As RISpec's DepthOfField.
    double f_stop = 0, focal_length = 1, focal_distance = 1;  ///< f_stop at defocus 1
    double shading_rate = 1;
    int most_layers = 0;  ///< of a sample; 0: all
    int blades = 0;       ///< of the aperture; 0: it is round
    double glow = 0;      ///< the part of what is brighter than 1 that is spread around
};

/// A whole RIB file of one frame; `write_world` writes what is in the world.
std::string scene_of(const Shot& shot, void (*write_world)(RibWriter&, const SceneParameters&),
                     const SceneParameters& parameters);

/// Writes a transformation whose numbers change by `change`, times parameters.motion, while the shutter is
/// open, and are `middle` at half of it.
void write_moving(RibWriter& rib, std::string_view request, const Numbers& middle, const Numbers& change,
                  const SceneParameters& parameters);

/// Quadrilaterals that move by themselves, as one mesh: corners in turn, when the shutter opens and closes.
struct MovingQuads {
    std::vector<V3d> open, close, colors;

    void add(const std::array<V3d, 4>& at_opening, const std::array<V3d, 4>& at_closing, const V3d& color);
    /// At rest, as when the shutter opens, where parameters.motion is 0.
    void write(RibWriter& rib, const SceneParameters& parameters) const;
};

/// Writes a plane or sky in one piece: the corners are in the order of a bilinear patch.
void write_bilinear(RibWriter& rib, const V3d (&corners)[4]);

// The scenes of scene_names().
#define TRAPEZE_SCENE(name, text) std::string text(const SceneParameters& parameters);
#include "pipeline/study/scenes/scenes.def"
#undef TRAPEZE_SCENE

}  // namespace trapeze::scenes
