/// Attributes and shaders (RISpec 4.2).
#include "pipeline/ri/in_order.h"

namespace trapeze::ri {
namespace {

/// Writes a call whose request has one array of `count` numbers.
void write_array(const char* name, const RtFloat* array, size_t count, const char* what) {
    call(name, [&](Context& context) {
        required(array, what);
        context.writer().request(name + 2);  // without its "Ri"
        context.writer().numbers({array, count});
    });
}

void write_color(const char* name, const RtFloat* color) {
    call(name, [&](Context& context) {
        required(color, "the colour");
        context.writer().request(name + 2);
        context.writer().numbers({color, static_cast<size_t>(context.counting.samples_per_color)});
    });
}

/// Writes a call whose request has one word.
void write_word(const char* name, RtToken word) {
    call(name, [&](Context& context) {
        required(word, "the word");
        context.writer().request(name + 2);
        context.writer().string(word);
    });
}

/// Writes a light. Handles count from 1 on; the handle of a call that is left out is null.
RtLightHandle write_light(const char* name, RtToken shader, const RiArguments& arguments) {
    RtLightHandle handle = nullptr;
    call(name, [&](Context& context) {
        required(shader, "the shader's name");
        const auto parameters = checked_parameters(context, arguments);
        ++context.lights;
        context.writer().request(name + 2);
        context.writer().string(shader);
        context.writer().number(static_cast<double>(context.lights));
        write_parameters(context.writer(), parameters);
        handle = reinterpret_cast<RtLightHandle>(context.lights);
    });
    return handle;
}

OrderedCall shader(Context&, const char* request, const RiArguments& parameters) {
    return {request, "the shader's name", parameters, {}, {}};
}

}  // namespace
}  // namespace trapeze::ri

using namespace trapeze::ri;

RtVoid RiColor(RtFloat color[]) {
    write_color("RiColor", color);
}

RtVoid RiOpacity(RtFloat opacity[]) {
    write_color("RiOpacity", opacity);
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
    write_word("RiShadingInterpolation", type);
}

RtVoid RiMatte(RtBoolean onoff) {
    write_numbers("Matte", {static_cast<float>(onoff)});
}

RtVoid RiBound(RtBound bound) {
    write_array("RiBound", bound, 6, "the bound");
}

RtVoid RiDetail(RtBound bound) {
    write_array("RiDetail", bound, 6, "the bound");
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
    write_word("RiGeometricRepresentation", type);
}

RtVoid RiOrientation(RtToken orientation) {
    write_word("RiOrientation", orientation);
}

RtVoid RiReverseOrientation() {
    write_numbers("ReverseOrientation", {});
}

RtVoid RiSides(RtInt sides) {
    write_numbers("Sides", {static_cast<float>(sides)});
}

#define RI_DEFINE_LIGHT(Type, Name, parameters, names, last)                                          \
    Type Ri##Name##V(RI_WITHOUT_BRACKETS parameters, RtInt n, RtToken tokens[], RtPointer values[]) { \
        return write_light("Ri" #Name, last, {n, tokens, values});                                    \
    }

RI_LIGHT_CALLS(RI_DEFINE_LIGHT)

#define RI_DEFINE_SHADER(Type, Name, parameters, names, last) \
    RI_DEFINE_IN_ORDER(shader, Name, parameters, names)

RI_SHADER_CALLS(RI_DEFINE_SHADER)

RtVoid RiAttributeV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    call("RiAttribute", [&](Context& context) {
        const std::string category = required(name, "the name");
        const auto parameters = checked_parameters(context, {n, tokens, values}, category);
        context.writer().request("Attribute");
        context.writer().string(category);
        write_parameters(context.writer(), parameters);
    });
}
