#include "shade/maps/openimageio/map_matrices.h"

namespace trapeze {

std::optional<MapMatrices> map_matrices(const OIIO::ImageSpec& spec) {
    MapMatrices found;
    if (!spec.getattribute("worldtocamera", OIIO::TypeMatrix, &found.camera_from_world)) return {};
    if (spec.getattribute("worldtoscreen", OIIO::TypeMatrix, &found.screen_from_world)) return found;
    M44f ndc_from_world;
    if (!spec.getattribute("worldtoNDC", OIIO::TypeMatrix, &ndc_from_world)) return {};
    // NDC runs from (0, 0) at the upper left to (1, 1) at the lower right (ImfStandardAttributes.h).
    const M44f screen_from_ndc(2, 0, 0, 0, 0, -2, 0, 0, 0, 0, 1, 0, -1, 1, 0, 1);
    found.screen_from_world = ndc_from_world * screen_from_ndc;
    return found;
}

}  // namespace trapeze
