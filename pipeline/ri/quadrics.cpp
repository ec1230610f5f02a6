/// Quadrics (RISpec 5.4).
#include "pipeline/ri/call.h"
#include "pipeline/ri/parameters.h"

namespace trapeze::ri {
namespace {

void write_quadric(const char* name, const char* request, std::initializer_list<float> numbers,
                   const RiArguments& arguments) {
    call(name, [&](Context& context) {
        const auto parameters = checked_parameters(context, arguments, variable_counts(Quadric{}));
        context.writer().request(request);
        for (const float number : numbers) context.writer().number(number);
        write_parameters(context.writer(), parameters);
    });
}

}  // namespace
}  // namespace trapeze::ri

using namespace trapeze::ri;

RtVoid RiSphereV(RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax, RtInt n, RtToken tokens[],
                 RtPointer values[]) {
    write_quadric("RiSphere", "Sphere", {radius, zmin, zmax, thetamax}, {n, tokens, values});
}

RtVoid RiConeV(RtFloat height, RtFloat radius, RtFloat thetamax, RtInt n, RtToken tokens[],
               RtPointer values[]) {
    write_quadric("RiCone", "Cone", {height, radius, thetamax}, {n, tokens, values});
}

RtVoid RiCylinderV(RtFloat radius, RtFloat zmin, RtFloat zmax, RtFloat thetamax, RtInt n, RtToken tokens[],
                   RtPointer values[]) {
    write_quadric("RiCylinder", "Cylinder", {radius, zmin, zmax, thetamax}, {n, tokens, values});
}

RtVoid RiHyperboloidV(RtPoint point1, RtPoint point2, RtFloat thetamax, RtInt n, RtToken tokens[],
                      RtPointer values[]) {
    if (!point1 || !point2)
        return report({RIE_MISSINGDATA, RIE_ERROR, "RiHyperboloid: a point is null; the call is left out"});
    write_quadric("RiHyperboloid", "Hyperboloid",
                  {point1[0], point1[1], point1[2], point2[0], point2[1], point2[2], thetamax},
                  {n, tokens, values});
}

RtVoid RiParaboloidV(RtFloat rmax, RtFloat zmin, RtFloat zmax, RtFloat thetamax, RtInt n, RtToken tokens[],
                     RtPointer values[]) {
    write_quadric("RiParaboloid", "Paraboloid", {rmax, zmin, zmax, thetamax}, {n, tokens, values});
}

RtVoid RiDiskV(RtFloat height, RtFloat radius, RtFloat thetamax, RtInt n, RtToken tokens[],
               RtPointer values[]) {
    write_quadric("RiDisk", "Disk", {height, radius, thetamax}, {n, tokens, values});
}

RtVoid RiTorusV(RtFloat majorradius, RtFloat minorradius, RtFloat phimin, RtFloat phimax, RtFloat thetamax,
                RtInt n, RtToken tokens[], RtPointer values[]) {
    write_quadric("RiTorus", "Torus", {majorradius, minorradius, phimin, phimax, thetamax},
                  {n, tokens, values});
}
