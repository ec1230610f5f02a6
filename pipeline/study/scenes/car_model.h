/// A car of a subdivision mesh, four spinning wheels and lamps, for scenes to write as often as they like.
#pragma once

#include "pipeline/study/scenes/scene_parts.h"

namespace trapeze::scenes {

/// A material of Surface "plastic", and its Color.
struct Plastic {
    V3d color;
    double kd, ks, roughness;
};

/// Makes the plastic the current surface.
void set_plastic(RibWriter& rib, const Plastic& plastic);

/// One car of a scene. Lengths are in metres.
struct Car {
    V3d place;       ///< of its middle, on the ground
    double heading;  ///< degrees from the z axis to the nose, about the y axis
    V3d paint;
    V3d moved;         ///< by how much the place changes while the shutter is open
    double driven;     ///< way along the ground meanwhile: what turns the wheels
    double head_lamp;  ///< the lamps' brightness
    double tail_lamp;
};

/// Writes the objects that cars are instances of: once in a world, before the cars.
void write_car_objects(RibWriter& rib);

/// Writes a car on a road of that plastic, to which the car's shadow fades.
void write_car(RibWriter& rib, const Car& car, const Plastic& road, const SceneParameters& parameters);

}  // namespace trapeze::scenes
