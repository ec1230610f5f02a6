/// Attributes and shaders (RISpec 4.2).
#include "pipeline/ri/call.h"
#include "pipeline/ri/parameters.h"

namespace trapeze::ri {
namespace {

void write_color(const char* name, const char* request, const RtFloat* color) {
    call(name, [&](Context& context) {
        required(color, "the colour");
        context.writer().request(request);
        context.writer().numbers({color, static_cast<size_t>(context.counting.samples_per_color)});
    });
}

void write_word(const char* name, const char* request, RtToken word) {
    call(name, [&](Context& context) {
        required(word, "the word");
        context.writer().request(request);
        context.writer().string(word);
    });
}

void write_box(const char* name, const char* request, const RtFloat* box) {
    call(name, [&](Context& context) {
        required(box, "the bound");
        context.writer().request(request);
        context.writer().numbers({box, 6});
    });
}

void write_shader(const char* name, const char* request, RtToken shader, const RiArguments& arguments) {
    call(name, [&](Context& context) {
        required(shader, "the shader's name");
        const auto parameters = checked_parameters(context, arguments);
        context.writer().request(request);
        context.writer().string(shader);
        write_parameters(context.writer(), parameters);
    });
}

RtLightHandle write_light(const char* name, const char* request, RtToken shader,
                          const RiArguments& arguments) {
    RtLightHandle handle = nullptr;
    call(name, [&](Context& context) {
        required(shader, "the shader's name");
        const auto parameters = checked_parameters(context, arguments);
        ++context.lights;
        context.writer().request(request);
        context.writer().string(shader);
        context.writer().number(static_cast<double>(context.lights));
        write_parameters(context.writer(), parameters);
        handle = reinterpret_cast<RtLightHandle>(context.lights);
    });
    return handle;
}

}  // namespace
}  // namespace trapeze::ri

using namespace trapeze::ri;

RtVoid RiColor(RtFloat color[]) {
    write_color("RiColor", "Color", color);
}

RtVoid RiOpacity(RtFloat opacity[]) {
    write_color("RiOpacity", "Opacity", opacity);
}

RtVoid RiTextureCoordinates(RtFloat s1, RtFloat t1, RtFloat s2, RtFloat t2, RtFloat s3, RtFloat t3,
                            RtFloat s4, RtFloat t4) {
    write_numbers("TextureCoordinates", {s1, t1, s2, t2, s3, t3, s4, t4});
}

RtVoid RiIlluminate(RtLightHandle light, RtBoolean onoff) {
    call("RiIlluminate", [&](Context& context) {
        const auto number = reinterpret_cast<uintptr_t>(light);
        if (number < 1 || number > context.lights) throw CallError{RIE_BADHANDLE, "no such light"};
        context.writer().request("Illuminate");
        context.writer().number(static_cast<double>(number));
        context.writer().number(onoff ? 1 : 0);
    });
}

RtVoid RiShadingRate(RtFloat size) {
    write_numbers("ShadingRate", {size});
}

RtVoid RiShadingInterpolation(RtToken type) {
    write_word("RiShadingInterpolation", "ShadingInterpolation", type);
}

RtVoid RiMatte(RtBoolean onoff) {
    write_numbers("Matte", {static_cast<float>(onoff)});
}

RtVoid RiBound(RtBound bound) {
    write_box("RiBound", "Bound", bound);
}

RtVoid RiDetail(RtBound bound) {
    write_box("RiDetail", "Detail", bound);
}

RtVoid RiDetailRange(RtFloat minvisible, RtFloat lowertransition, RtFloat uppertransition,
                     RtFloat maxvisible) {
    write_numbers("DetailRange", {minvisible, lowertransition, uppertransition, maxvisible});
}

RtVoid RiGeometricApproximation(RtToken type, RtFloat value) {
    call("RiGeometricApproximation", [&](Context& context) {
        required(type, "the type");
        context.writer().request("GeometricApproximation");
        context.writer().string(type);
        context.writer().number(value);
    });
}

RtVoid RiGeometricRepresentation(RtToken type) {
    write_word("RiGeometricRepresentation", "GeometricRepresentation", type);
}

RtVoid RiOrientation(RtToken orientation) {
    write_word("RiOrientation", "Orientation", orientation);
}

RtVoid RiReverseOrientation() {
    write_numbers("ReverseOrientation", {});
}

RtVoid RiSides(RtInt sides) {
    write_numbers("Sides", {static_cast<float>(sides)});
}

RtLightHandle RiLightSourceV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    return write_light("RiLightSource", "LightSource", name, {n, tokens, values});
}

RtLightHandle RiAreaLightSourceV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    return write_light("RiAreaLightSource", "AreaLightSource", name, {n, tokens, values});
}

RtVoid RiSurfaceV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    write_shader("RiSurface", "Surface", name, {n, tokens, values});
}

RtVoid RiDisplacementV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    write_shader("RiDisplacement", "Displacement", name, {n, tokens, values});
}

RtVoid RiAtmosphereV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    write_shader("RiAtmosphere", "Atmosphere", name, {n, tokens, values});
}

RtVoid RiInteriorV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    write_shader("RiInterior", "Interior", name, {n, tokens, values});
}

RtVoid RiExteriorV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    write_shader("RiExterior", "Exterior", name, {n, tokens, values});
}

RtVoid RiDeformationV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    write_shader("RiDeformation", "Deformation", name, {n, tokens, values});
}

RtVoid RiAttributeV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    call("RiAttribute", [&](Context& context) {
        const std::string category = required(name, "the name");
        const auto parameters = checked_parameters(context, {n, tokens, values}, category);
        context.writer().request("Attribute");
        context.writer().string(category);
        write_parameters(context.writer(), parameters);
    });
}
