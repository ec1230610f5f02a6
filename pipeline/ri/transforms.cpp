/// Transformations and coordinate systems (RISpec 4.3).
#include "pipeline/ri/call.h"
#include "pipeline/ri/parameters.h"

namespace trapeze::ri {
namespace {

using rib::TransformKind;

/// Numbers one by one, and what they do to the current space.
void transform(const char* name, const char* request, TransformKind kind,
               const rib::TransformArguments& numbers) {
    call(name, [&](Context& context) {
        if (context.counts()) context.spaces.concat(kind, numbers);
        context.writer().request(request);
        for (const float number : numbers) context.writer().number(number);
    });
}

void name_space(const char* name, const char* request, RtToken space) {
    call(name, [&](Context& context) {
        required(space, "the name");
        context.spaces.name_current(space);
        context.writer().request(request);
        context.writer().string(space);
    });
}

}  // namespace
}  // namespace trapeze::ri

using namespace trapeze::ri;

RtVoid RiIdentity() {
    call("RiIdentity", [](Context& context) {
        if (context.counts()) context.spaces.set(trapeze::M44d());
        context.writer().request("Identity");
    });
}

RtVoid RiTransform(RtMatrix matrix) {
    call("RiTransform", [&](Context& context) {
        const std::vector<float> numbers(&required(matrix, "the matrix")[0][0], &matrix[0][0] + 16);
        if (context.counts())
            context.spaces.set(trapeze::rib::transform_matrix(TransformKind::Matrix, numbers));
        context.writer().request("Transform");
        context.writer().numbers(numbers);
    });
}

RtVoid RiConcatTransform(RtMatrix matrix) {
    call("RiConcatTransform", [&](Context& context) {
        const std::vector<float> numbers(&required(matrix, "the matrix")[0][0], &matrix[0][0] + 16);
        if (context.counts()) context.spaces.concat(TransformKind::Matrix, numbers);
        context.writer().request("ConcatTransform");
        context.writer().numbers(numbers);
    });
}

RtVoid RiPerspective(RtFloat fov) {
    transform("RiPerspective", "Perspective", TransformKind::Perspective, {fov});
}

RtVoid RiTranslate(RtFloat dx, RtFloat dy, RtFloat dz) {
    transform("RiTranslate", "Translate", TransformKind::Translate, {dx, dy, dz});
}

RtVoid RiRotate(RtFloat angle, RtFloat dx, RtFloat dy, RtFloat dz) {
    transform("RiRotate", "Rotate", TransformKind::Rotate, {angle, dx, dy, dz});
}

RtVoid RiScale(RtFloat sx, RtFloat sy, RtFloat sz) {
    transform("RiScale", "Scale", TransformKind::Scale, {sx, sy, sz});
}

RtVoid RiSkew(RtFloat angle, RtFloat dx1, RtFloat dy1, RtFloat dz1, RtFloat dx2, RtFloat dy2, RtFloat dz2) {
    transform("RiSkew", "Skew", TransformKind::Skew, {angle, dx1, dy1, dz1, dx2, dy2, dz2});
}

RtVoid RiCoordinateSystem(RtToken space) {
    name_space("RiCoordinateSystem", "CoordinateSystem", space);
}

RtVoid RiScopedCoordinateSystem(RtToken space) {
    name_space("RiScopedCoordinateSystem", "ScopedCoordinateSystem", space);
}

RtVoid RiCoordSysTransform(RtToken space) {
    call("RiCoordSysTransform", [&](Context& context) {
        required(space, "the name");
        if (context.counts() && !context.spaces.use(space))  // an archive may have named it
            context.complain(RIE_BADTOKEN, RIE_WARNING,
                             "no space \"" + std::string(space) + "\" has been named");
        context.writer().request("CoordSysTransform");
        context.writer().string(space);
    });
}

RtPoint* RiTransformPoints(RtToken fromspace, RtToken tospace, RtInt npoints, RtPoint points[]) {
    RtPoint* transformed = nullptr;
    call("RiTransformPoints", [&](Context& context) {
        required(fromspace, "the space"), required(tospace, "the space");
        array_of(points, npoints, "points");
        const auto matrix = context.spaces.between(fromspace, tospace);
        if (!matrix)
            throw CallError{RIE_BADTOKEN, "no way from \"" + std::string(fromspace) + "\" to \"" +
                                              std::string(tospace) + "\""};
        for (RtInt i = 0; i < npoints; ++i) {
            trapeze::V3d to;
            matrix->multVecMatrix(trapeze::V3d(points[i][0], points[i][1], points[i][2]), to);
            for (int k = 0; k < 3; ++k) points[i][k] = static_cast<RtFloat>(to[k]);
        }
        transformed = points;
    });
    return transformed;
}
