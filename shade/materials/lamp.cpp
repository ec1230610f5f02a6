#include "shade/materials/lamp.h"

#include "core/motion_keys.h"

namespace trapeze {

int Lamp::turns() const {
    if (!area) return 1;
    for (const auto& sampler : samplers)
        if (sampler) return sampler->is_point() && !moves() ? 1 : area->shape->samples;
    return 0;
}

float Lamp::time_near(float time) const {
    return moves() && time > 0 ? middle_of_part(part_of_shutter(time, parts()), parts()) : 0;
}

const LightSampler* Lamp::sampler_at(float time) const {
    if (samplers.empty()) return nullptr;
    return samplers[moves() && time > 0 ? 1 + part_of_shutter(time, parts()) : 0].get();
}

}  // namespace trapeze
