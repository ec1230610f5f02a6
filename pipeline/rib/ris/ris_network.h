/// What the path tracer's shaders (RIS) leave for one another, and how their surfaces look from afar: RIS
/// shaders are not run, but a surface has the colour, or the texture, that they are told.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "pipeline/rib/ris/ris_parameters.h"

namespace trapeze::rib {

/// A Pattern request as it stood; looked into when a Bxdf refers to it.
struct RisPattern {
    std::string shader;
    RisParameters parameters;
};

/// How a surface looks from afar.
struct RisLook {
    std::optional<V3f> color;  ///< none: nothing says it
    V3f specular{0, 0, 0};     ///< of its highlights
    V3f emission{0, 0, 0};
    float roughness = 0.2f;  ///< of RSL's specular()
    float opacity = 1;
    float scale_s = 1, scale_t = 1;  ///< how often the texture repeats
    std::string texture;             ///< its colour is that of a file; empty: none
    std::string colorspace = {};     ///< of that, as texture() takes it
    bool is_constant = false;        ///< light does not matter

    bool operator==(const RisLook&) const = default;
};

/// All are looked up by handles, the latest of a handle counting. Part of Scope: what a frame or a world has
/// defined ends with it.
struct RisNetwork {
    std::map<std::string, RisPattern> patterns;
    std::map<std::string, RisLook> bxdfs;
    std::map<std::string, RisLook> materials;  ///< by "__materialid", which later Bxdfs may name alone
    /// Lights that shine on all of the world, wherever they stand in it.
    std::vector<std::shared_ptr<const LightInstance>> lights;
};

/// How the Bxdf `shader` with these parameters looks; patterns and Bxdfs that it names are those of the
/// network so far.
RisLook look_of_bxdf(const std::string& shader, const RisParameters& parameters, const RisNetwork& network);

}  // namespace trapeze::rib
