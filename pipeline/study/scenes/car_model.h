/// A car of a subdivision mesh, four spinning wheels and lamps, for scenes to write as often as they like.
#pragma once

#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {

/// Surface "plastic" and its Color.
struct Plastic {
    V3d color;
    double kd, ks, roughness;
};

void set_plastic(RibWriter& rib, const Plastic& plastic);

struct Car {
    V3d place;       ///< of its middle, on the ground
    double heading;  ///< degrees from the z axis to the nose, about the y axis
    V3d paint;
    V3d moved;         ///< while the shutter is open
    double driven;     ///< on the ground meanwhile: what turns the wheels
    double head_lamp;  ///< the lamps' brightness
    double tail_lamp;
};

/// Once in a world, before the cars: the objects they are instances of.
void write_car_objects(RibWriter& rib);

/// On a road of that plastic, which the car's shadow fades to.
void write_car(RibWriter& rib, const Car& car, const Plastic& road, const SceneParameters& parameters);

}  // namespace trapeze::scenes
