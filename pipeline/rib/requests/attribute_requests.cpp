/// RISpec 4.2: what is attached to primitives.
#include <algorithm>
#include <cmath>

#include "pipeline/rib/requests/request_table.h"
#include "pipeline/rib/requests/ri_values.h"
#include "pipeline/rib/state/attribute_values.h"
#include "pipeline/rib/state/bases.h"
#include "pipeline/rib/state/recognised_names.h"

namespace trapeze::rib {
namespace {

/// A colour of as many numbers as colours have (ColorSamples). One number for all and one too many are
/// mistakes that files have, and that renderers take.
V3f color_of(StateContext& r, ArgumentCursor& c, const char* what) {
    const size_t samples = r.state.scope().samples_per_color();
    const SourceLocation at = c.done() ? SourceLocation{} : c.peek()->at;
    std::vector<float> given = c.next_is_array() ? c.number_array(what) : c.numbers(1, samples, what);
    if (given.size() != samples && given.size() != 1 && given.size() != samples + 1)
        throw RequestError{std::string(what) + " has " + std::to_string(given.size()) + " numbers, needs " +
                               std::to_string(samples),
                           at};
    if (given.size() < samples)
        r.report.warn_once("one number for " + std::string(what) + "; all of it is taken to be that",
                           "grey-color");
    if (given.size() > samples)
        r.report.warn_once("a number too many for " + std::string(what), "long-color");
    given.resize(samples, given[0]);
    const auto v = r.state.scope().rgb(std::move(given));
    return {v[0], v[1], v[2]};
}

/// Opacity color: how much of what lies behind is covered, by channel.
void opacity(StateContext& r, ArgumentCursor& c) {
    const V3f o = color_of(r, c, "the opacity");
    changeable_attributes(r, Own::Opacity).opacity = o;
}

/// TextureCoordinates s1 t1 s2 t2 s3 t3 s4 t4: s and t at the corners (0,0), (1,0), (0,1), (1,1) of u and v.
void texture_coordinates(StateContext& r, ArgumentCursor& c) {
    const auto v = c.numbers(8, "the coordinates");
    std::copy(v.begin(), v.end(),
              changeable_attributes(r, Own::TextureCoordinates).texture_coordinates.begin());
}

/// ShadingRate area: so many pixels a micropolygon may cover.
void shading_rate(StateContext& r, ArgumentCursor& c) {
    const float rate = c.number("the rate");
    if (!(rate > 0)) throw RequestError{"the rate must be positive", {}};
    changeable_attributes(r, Own::ShadingRate).shading_rate = rate;
}

/// ShadingInterpolation "constant" or "smooth": of a grid's colours, over each micropolygon.
void shading_interpolation(StateContext& r, ArgumentCursor& c) {
    const std::string type = c.string("the type");
    if (type != "constant" && type != "smooth")
        throw RequestError{in_quotes(type) + " is neither constant nor smooth", {}};
    changeable_attributes(r, Own::ShadingInterpolation).smooth_shading = type == "smooth";
}

/// Matte flag: what hides others but is not seen itself. 1 leaves a hole in colour and alpha, 2 in the colour
/// alone.
void matte(StateContext& r, ArgumentCursor& c) {
    changeable_attributes(r, Own::Matte).matte = c.integer("the flag", 0, 2);
}

/// Sides 1 or 2: of 1 only those that face the eye are seen.
void sides(StateContext& r, ArgumentCursor& c) {
    const float n = c.number("1 or 2");
    if (n != 1 && n != 2) throw RequestError{"must be 1 or 2", {}};
    changeable_attributes(r, Own::Sides).sides = static_cast<int>(n);
}

/// Orientation. "lh" and "rh" are kept as "outside" where they name the handedness of the current space and
/// as "inside" where they name the other one: later reflections flip both kinds alike.
void orientation(StateContext& r, ArgumentCursor& c) {
    const std::string name = c.string("the orientation");
    if (name != "outside" && name != "inside" && name != "lh" && name != "rh")
        throw RequestError{in_quotes(name) + " is none of outside, inside, lh, rh", {}};
    const bool mismatches = name == (r.state.is_right_handed() ? "lh" : "rh");
    AttributeState& state = r.state.change_attributes();
    state.orientation = name == "inside" || mismatches ? Orientation::Inside : Orientation::Outside;
    state.orientation_reversed = false;
}

/// ReverseOrientation: normals point to the other side from now on.
void reverse_orientation(StateContext& r, ArgumentCursor&) {
    AttributeState& state = r.state.change_attributes();
    state.orientation_reversed = !state.orientation_reversed;
}

/// A name or a matrix, and its step, which may be left out. A step that is left out is the named basis' own,
/// or 3 for a matrix.
CubicBasis read_basis(ArgumentCursor& c, const char* what) {
    CubicBasis basis;
    if (c.next_is_string()) {
        const std::string name = c.string(what);
        const std::optional<CubicBasis> named = basis_named(name);
        if (!named) throw RequestError{"no basis " + in_quotes(name), {}};
        basis = *named;
    } else {
        const auto v = c.numbers(16, what);
        for (int i = 0; i < 16; ++i) basis.matrix[i / 4][i % 4] = v[i];
    }
    if (c.next_is_number() && !c.next_is_array()) basis.step = c.integer("a step", 1, 4);
    return basis;
}

/// Basis u ustep v vstep (RISpec 5.2): of the bicubic patches and cubic curves to come.
void basis(StateContext& r, ArgumentCursor& c) {
    const CubicBasis u = read_basis(c, "the u basis"), v = read_basis(c, "the v basis");
    AttributeState& state = r.state.change_attributes();
    state.u_basis = u.matrix, state.v_basis = v.matrix, state.u_step = u.step, state.v_step = v.step;
}

/// Attribute "identifier" "name". The asset is what the outermost block with a name has named.
void name_primitives(const GraphicsStateStack& stack, const std::string& name, AttributeState& state) {
    state.attributes.name = name;
    const uint64_t block = stack.blocks().empty() ? 0 : stack.blocks().back().id;
    if (!state.attributes.asset.empty() && state.asset_block != block) return;
    state.attributes.asset = name, state.asset_block = block;
}

/// Attribute "trimcurve" "sense": the side of the curves on which a surface is cut away.
void set_trim_sense(OptionContext& r, const std::string& sense, AttributeState& state) {
    if (sense != "inside" && sense != "outside")
        r.report.error("the sense " + in_quotes(sense) + " is neither inside nor outside");
    state.trim_outside = sense == "outside";
}

/// Each value is counted once: as not needed, as without effect, or not at all where something looks at it.
void count_value(OptionContext& r, const std::string& category, const Parameter& value) {
    if (const UnneededAttribute* const unneeded = unneeded_attribute(category, value.name))
        r.report.count_not_needed(' ' + in_quotes(category) + ' ' + in_quotes(value.name) + ": " +
                                  std::string(unneeded->why));
    else if (!recognises_attribute(category, value.name))
        r.report.count_without_effect(' ' + in_quotes(category) + ' ' + in_quotes(value.name));
}

/// All values are kept for shaders (RISpec: attribute()); those that mean something here are taken too.
void attribute(OptionContext& r, ArgumentCursor& c) {
    static const std::string none;
    const std::string category = c.string("the category");
    const ParameterList values = r.parameters(c, Undeclared::Guess);
    for (const Parameter& value : values.values) {
        AttributeState& state = r.state.change_attributes();
        set_attribute_value(category, value, state);
        if (r.state.in_object()) state.own.set(category, value);
        const std::string_view known = category, name = value.name;
        const std::string& text = value.strings.empty() ? none : value.strings[0];
        if (known == "trimcurve" && name == "sense") set_trim_sense(r, text, state);
        if (known == "identifier" && name == "name")
            name_primitives(r.state, text, r.state.change_attributes(Own::Name));
        if (shading_rate_of(category, value)) r.state.change_attributes(Own::ShadingRate);
        if (known != "Ri" || !execute_ri_value(r, value)) count_value(r, category, value);
    }
}

/// A motion block holds these, and has each carried out once (RequestGroup::Attribute).
constexpr RequestRow kAttributeRequests[] = {
    {"Attribute", attribute},
    {"Color",
     [](StateContext& r, ArgumentCursor& c) {
         const V3f v = color_of(r, c, "the colour");
         changeable_attributes(r, Own::Color).color = v;
     }},
    {"Opacity", opacity},
    {"TextureCoordinates", texture_coordinates},
    {"ShadingRate", shading_rate},
    {"ShadingInterpolation", shading_interpolation},
    {"Matte", matte},
    {"Sides", sides},
    {"Orientation", orientation},
    {"ReverseOrientation", reverse_orientation},
    {"Basis", basis},
};

}  // namespace

std::span<const RequestRow> attribute_requests() {
    return kAttributeRequests;
}

}  // namespace trapeze::rib
