#include "pipeline/study/scenes/car_model.h"

#include <algorithm>
#include <array>

#include "pipeline/study/scenes/car_body.h"
#include "pipeline/study/scenes/quad_mesh.h"

namespace trapeze::scenes {
namespace {

// In metres: z towards the nose, y up.
constexpr double kAxle = 1.40, kTrack = .80, kWheelRadius = .335;

/// The objects that cars are instances of.
enum Piece { kPaint, kGlass, kTrim, kTailLamps, kTyre, kRim, kBrake };

/// One of five double spokes: two sloping faces in front and two sides.
void add_spoke(QuadMesh& mesh, double angle) {
    const auto at = [&](double radius, double across, double z) {
        return V3d(radius * std::cos(angle) - across * std::sin(angle),
                   radius * std::sin(angle) + across * std::cos(angle), z);
    };
    const V3d inner = at(.03, 0, .075), outer = at(.238, 0, .088), metal(.72, .74, .78);
    for (const double side : {-1., 1.}) {
        const V3d a = at(.03, .026 * side, .055), b = at(.238, .020 * side, .070), in(0, 0, -.05);
        mesh.add({inner, outer, b, a}, metal);
        mesh.add({a, b, b + in, a + in}, metal * .5);
    }
}

// Parts of a wheel about the z axis, its outer side towards positive z.

void write_tyre(RibWriter& rib) {
    {
        const auto wide = rib.block("Transform");
        rib.request("Scale", 1, 1, 1.25);
        rib.request("Torus", kWheelRadius - .075, .075, 0, 360, 360);
    }
    rib.request("Disk", -.03, .25, 360);
}

void write_rim(RibWriter& rib) {
    {
        const auto outwards = rib.block("Transform");
        rib.request("Translate", 0, 0, .065);
        rib.request("Torus", .240, .013, 0, 360, 360);
        rib.request("Sphere", .045, 0, .045, 360);
    }
    QuadMesh spokes;
    for (int i = 0; i < 5; ++i)
        for (const double side : {-.17, .17}) add_spoke(spokes, .4 * kPi * i + side);
    spokes.write(rib);
}

void write_brake(RibWriter& rib) {
    rib.request("Disk", 0, .165, 360);
    rib.request("Cylinder", .165, -.02, 0, 360);
}

void instance(RibWriter& rib, Piece piece) {
    rib.request("ObjectInstance", static_cast<int>(piece) + 1);
}

void write_ellipsoid(RibWriter& rib, const V3d& place, const V3d& radii) {
    const auto whole = rib.block("Transform");
    rib.request("Translate", place.x, place.y, place.z);
    rib.request("Scale", radii.x, radii.y, radii.z);
    rib.request("Sphere", 1, -1, 1, 360);
}

void write_wheels(RibWriter& rib, const Car& car, const SceneParameters& p) {
    for (const double side : {-1., 1.})
        for (const double axle : {-kAxle, kAxle}) {
            const auto wheel = rib.block("Attribute");
            rib.request("Translate", side * kTrack, kWheelRadius, axle);
            // Driving on, the wheel's top goes towards the nose.
            write_moving(rib, "Rotate", {17, 1, 0, 0}, {car.driven / kWheelRadius * 180 / kPi, 0, 0, 0}, p);
            rib.request("Rotate", side * 90, 0, 1, 0);
            set_plastic(rib, {{.012, .012, .014}, .8, .06, .8});
            instance(rib, kTyre);
            set_plastic(rib, {{.52, .53, .57}, .6, .5, .4});
            instance(rib, kRim);
            rib.request("Color", Numbers{.16, .15, .15});
            instance(rib, kBrake);
        }
}

/// What is under the body: black, so that nobody looks through the arches.
void write_underside(RibWriter& rib) {
    rib.request("Surface", "matte");
    QuadMesh mesh;
    mesh.add_box({-.62, .17, -1.95}, {.62, .62, 1.95}, V3d(.006));
    for (const double side : {-1., 1.})
        for (const double axle : {-kAxle, kAxle})
            mesh.add_box({std::min(side * .62, side * .70), .3, axle - .4},
                         {std::max(side * .62, side * .70), .72, axle + .4}, V3d(.004));
    mesh.write(rib);
    set_plastic(rib, {{.02, .02, .022}, .8, .15, .16});
}

/// What the lamps above leave dark: a sheet just above the road, of its colour at the edge.
void write_shadow(RibWriter& rib, const V3d& road) {
    constexpr std::array<double, 4> kX = {-1.45, -.72, .72, 1.45}, kZ = {-2.9, -1.9, 1.9, 2.9};
    std::vector<V3d> points, colors;
    for (size_t j = 0; j < 4; ++j)
        for (size_t i = 0; i < 4; ++i) {
            points.emplace_back(kX[i], .012, kZ[j]);
            const bool edge = i == 0 || i == 3 || j == 0 || j == 3;
            colors.push_back(edge ? road : V3d(.001));
        }
    rib.request("PatchMesh", "bilinear", 4, "nonperiodic", 4, "nonperiodic", "P", flattened(points),
                "varying color Cs", flattened(colors));
}

void write_lamp(RibWriter& rib, const V3d& place, const V3d& radii, const V3d& color) {
    rib.request("Color", Numbers{color.x, color.y, color.z});
    write_ellipsoid(rib, place, radii);
}

void write_lamps(RibWriter& rib, const Car& car) {
    rib.request("Surface", "constant");
    const V3d white = V3d(1, .95, .86) * car.head_lamp, red = V3d(1, .06, .03) * car.tail_lamp;
    for (const double side : {-1., 1.}) {
        write_lamp(rib, {side * .765, .605, 2.07}, {.048, .042, .05}, white);
        write_lamp(rib, {side * .655, .600, 2.135}, {.044, .038, .05}, white * .7);
        write_lamp(rib, {side * .68, .548, 2.125}, {.10, .010, .065}, white * .3);
        write_lamp(rib, {side * .66, .86, -2.14}, {.10, .035, .04}, red);
    }
    rib.request("Color", Numbers{red.x * .12, red.y * .12, red.z * .12});
    instance(rib, kTailLamps);
}

/// In front: bars of the grille and a number plate.
void write_front(RibWriter& rib) {
    set_plastic(rib, {{.45, .46, .50}, .6, .8, .24});
    for (const double y : {.575, .615, .655})
        write_ellipsoid(rib, {0, y, 2.195 + .5 * (.655 - y)}, {.44, .009, .055});
    rib.request("Surface", "matte");
    QuadMesh plate;
    plate.add_lamp({0, .455, 2.34}, .26, .055, {.70, .70, .66});
    for (int i = -3; i < 4; ++i)
        if (i != -1) plate.add_lamp({.062 * i, .455, 2.342}, .019, .035, V3d(.03));
    plate.write(rib);
}

void write_mirrors_and_handles(RibWriter& rib) {
    for (const double side : {-1., 1.}) {
        write_ellipsoid(rib, {side * .93, .80, -.32}, {.022, .018, .10});
        write_ellipsoid(rib, {side * .95, .98, .52}, {.115, .072, .06});
    }
}

}  // namespace

void set_plastic(RibWriter& rib, const Plastic& plastic) {
    rib.request("Surface", "plastic", "Kd", Numbers{plastic.kd}, "Ks", Numbers{plastic.ks}, "roughness",
                Numbers{plastic.roughness});
    rib.request("Color", Numbers{plastic.color.x, plastic.color.y, plastic.color.z});
}

void write_car_objects(RibWriter& rib) {
    const auto object = [&](Piece piece, const auto& write, auto... what) {
        rib.request("ObjectBegin", static_cast<int>(piece) + 1);
        write(rib, what...);
        rib.request("ObjectEnd");
    };
    object(kPaint, write_car_body, BodyPiece::kPaint);
    object(kGlass, write_car_body, BodyPiece::kGlass);
    object(kTrim, write_car_body, BodyPiece::kTrim);
    object(kTailLamps, write_car_body, BodyPiece::kTailLamps);
    object(kTyre, write_tyre);
    object(kRim, write_rim);
    object(kBrake, write_brake);
}

void write_car(RibWriter& rib, const Car& car, const Plastic& road, const SceneParameters& p) {
    const auto whole = rib.block("Attribute");
    write_moving(rib, "Translate", {car.place.x, car.place.y, car.place.z},
                 {car.moved.x, car.moved.y, car.moved.z}, p);
    rib.request("Rotate", car.heading, 0, 1, 0);
    set_plastic(rib, road);
    write_shadow(rib, road.color);
    set_plastic(rib, {car.paint, .7, 1.1, .144});
    instance(rib, kPaint);
    write_mirrors_and_handles(rib);
    set_plastic(rib, {{.010, .013, .02}, .8, .9, .096});
    instance(rib, kGlass);
    write_underside(rib);
    instance(rib, kTrim);
    write_wheels(rib, car, p);
    write_front(rib);
    write_lamps(rib, car);
}

}  // namespace trapeze::scenes
