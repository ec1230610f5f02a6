/// Parameter lists: the pairs of a name and a value at the end of requests (RISpec, appendix C.2). A wrong
/// pair costs itself, not its request.
#include "pipeline/rib/reader/request_context.h"

#include <algorithm>

#include "pipeline/rib/map_request.h"
#include "pipeline/rib/reader/request_report.h"
#include "pipeline/rib/reader/scene_builder.h"
#include "pipeline/rib/state/graphics_state_stack.h"

namespace trapeze::rib {
namespace {

constexpr size_t kMostReserved = 8;       ///< parameters that memory is taken for before they are read
constexpr size_t kMostParameters = 1000;  ///< of one request; lists are searched one by one

/// What an undeclared value looks like.
Declaration guessed(size_t numbers, size_t strings) {
    const size_t length = strings > 0 ? strings : numbers;
    return {StorageClass::Uniform, strings > 0 ? ValueType::String : ValueType::Float,
            static_cast<int>(std::clamp<size_t>(length, 1, kLongestArray))};
}

/// Whether values of this number and kind can be what the declaration says.
bool fits(const Declaration& declaration, size_t numbers, size_t strings) {
    const size_t item = component_count(declaration.type) * static_cast<size_t>(declaration.array_length);
    const bool is_string = declaration.type == ValueType::String;
    const size_t got = is_string ? strings : numbers;
    return (is_string ? numbers : strings) == 0 && got > 0 && got % item == 0;
}

/// One name and value pair, checked against its declaration. A name without a value throws a RequestError. A
/// wrong pair is passed over as a whole, so that the next name is found where it stands.
class ParameterReader {
  public:
    ParameterReader(RequestReport& report, const GraphicsStateStack& state, ArgumentCursor& cursor,
                    Undeclared undeclared)
        : report_(report), state_(state), cursor_(cursor), undeclared_(undeclared) {}

    /// False when the pair is wrong, which has been reported.
    bool read(const ParameterList& earlier, Parameter& parameter) {
        if (!cursor_.next_is_string() || cursor_.peek()->strings.size() != 1)
            throw RequestError{"a parameter's name is expected", cursor_.peek()->at};
        name_at_ = cursor_.peek()->at;
        std::string token = cursor_.string("a parameter's name");
        if (cursor_.done()) throw RequestError{in_quotes(token) + " has no value", name_at_};
        if (earlier.values.size() >= kMostParameters)
            throw RequestError{"more than " + std::to_string(kMostParameters) + " parameters", name_at_};
        // The memory of the arrays is moved, not copied: the text of a request is read once, and its largest
        // part by far are the points of meshes.
        Argument& value = cursor_.take_here();
        std::vector<float> numbers = value.take_numbers();
        // Several bare numbers may stand for an array of a fixed size (a colour, say).
        while (value.kind == Argument::Kind::Number && cursor_.next_is_number() && !cursor_.next_is_array())
            numbers.push_back(cursor_.number("a value"));
        if (!declare(parameter, token, numbers.size(), value.strings.size())) {
            report_.say(Severity::Error, name_at_, in_quotes(token) + " is not declared; left out",
                        "undeclared-" + token);
            return false;
        }
        parameter.floats = std::move(numbers), parameter.strings = std::move(value.strings);
        if (!fit_to_declaration(parameter)) return false;
        if (earlier.find(parameter.name)) {
            report_.say(Severity::Warning, name_at_,
                        in_quotes(parameter.name) + " is given twice; the first counts",
                        "repeated-parameter");
            return false;
        }
        if (parameter.declaration.type == ValueType::Color)
            parameter.floats = state_.scope().rgb(std::move(parameter.floats));
        return true;
    }

  private:
    /// Takes name and type from the token, which is left as it is where it is unknown. A token with a space
    /// in it that is no declaration was meant to be one: it is not guessed.
    bool declare(Parameter& parameter, std::string& token, size_t numbers, size_t strings) {
        const Declarations::Meaning* const meaning = state_.declarations().find(token);
        // A shader's or a renderer's own parameter of a name that RISpec gives another type to.
        const bool is_another = undeclared_ == Undeclared::Guess && meaning && meaning->is_predeclared &&
                                !state_.scope().color_samples &&
                                !fits(meaning->declaration, numbers, strings);
        const bool may_guess = undeclared_ == Undeclared::Guess && token.find(' ') == std::string::npos;
        if (!meaning && !may_guess) return false;
        const bool is_guessed = is_another || !meaning;
        parameter.declaration = is_guessed ? guessed(numbers, strings) : meaning->declaration;
        // A token that is as long as its name is the name.
        if (is_guessed || meaning->name.size() == token.size())
            parameter.name = std::move(token);
        else
            parameter.name = meaning->name;
        return true;
    }

    /// Values beyond the last whole item are left over; too few, or of the wrong kind, are none.
    bool fit_to_declaration(Parameter& p) {
        const bool is_string = p.declaration.type == ValueType::String;
        if (is_string ? !p.floats.empty() : !p.strings.empty()) {
            report_.error(name_at_,
                          in_quotes(p.name) + " wants " + (is_string ? "strings" : "numbers") + "; left out");
            return false;
        }
        const size_t got = is_string ? p.strings.size() : p.floats.size();
        const bool is_color = p.declaration.type == ValueType::Color;
        const size_t components =
            is_color ? state_.scope().samples_per_color() : component_count(p.declaration.type);
        const size_t item = components * static_cast<size_t>(p.declaration.array_length);
        const auto has = [&] { return in_quotes(p.name) + " has " + std::to_string(got) + " values, "; };
        if (got < item) {
            report_.error(name_at_, has() + "needs a multiple of " + std::to_string(item) + "; left out");
            return false;
        }
        if (got % item != 0) {
            report_.diagnostics().warning(name_at_,
                                          report_.name() + ": " + has() + "no multiple of " +
                                              std::to_string(item) + "; the rest is left over",
                                          "surplus-numbers");
            (is_string ? p.strings.resize(got - got % item) : p.floats.resize(got - got % item));
        }
        return true;
    }

    RequestReport& report_;
    const GraphicsStateStack& state_;
    ArgumentCursor& cursor_;
    const Undeclared undeclared_;
    SourceLocation name_at_;
};

}  // namespace

/// A repeated name is a mistake of the file: its first value counts.
ParameterList RequestContext::parameters(ArgumentCursor& cursor, Undeclared undeclared) const {
    ParameterList list;
    if (cursor.done()) return list;
    list.values.reserve(std::min(cursor.left() / 2, kMostReserved));
    ParameterReader reader(report, declared_, cursor, undeclared);
    while (!cursor.done())
        if (Parameter parameter; reader.read(list, parameter)) list.values.push_back(std::move(parameter));
    return list;
}

/// A shader's argument is one value or one array, as it is declared. What has another number of values was
/// meant for another shader.
ParameterList RequestContext::shader_parameters(ArgumentCursor& cursor) const {
    ParameterList list = parameters(cursor, Undeclared::Guess);
    std::erase_if(list.values, [&](const Parameter& p) {
        const size_t got = p.is_string() ? p.strings.size() : p.floats.size();
        const int wanted = p.is_string() ? p.declaration.array_length : p.declaration.floats_per_item();
        if (got == static_cast<size_t>(wanted)) return false;
        report.error(in_quotes(p.name) + " has " + std::to_string(got) + " values, needs " +
                     std::to_string(wanted) + "; left out");
        return true;
    });
    return list;
}

/// Shaders run in the space where their request stands ("shader" space). Whether there is such a shader is
/// found when the world is rendered; the reader needs none.
ShaderInstance RequestContext::shader(ArgumentCursor& cursor, const char* kind) const {
    ShaderInstance instance;
    instance.name = cursor.string("the shader's name");
    instance.location = report.at();
    instance.camera_from_shader = declared_.camera_from_current();
    ++report.summary().shaders[std::string(kind) + " " + instance.name];
    return instance;
}

/// The contexts hand these on, rather than show the whole SceneBuilder: a handler can do what its family may.
void LightContext::add_light(std::shared_ptr<const LightInstance> light) {
    scene_.add_light(std::move(light));
}

bool LightContext::add_world_light(std::shared_ptr<const LightInstance> light) {
    return scene_.add_world_light(std::move(light));
}

void LightContext::add_light_surface(const LightInstance& light) {
    scene_.add_light_surface(light);
}

std::shared_ptr<const LightInstance> LightContext::light(const std::string& handle) const {
    return scene_.light(handle);
}

void GeometryContext::add_shape(const std::string& request, Shape&& shape, uint64_t faces) {
    scene_.add_shape(request, std::move(shape), faces);
}

void GeometryContext::place_far_emitter(FarShape shape, float angle) {
    scene_.place_far_emitter(shape, angle);
}

void MapContext::make_map(MapRequest request) {
    scene_.make_map(std::move(request));
}

}  // namespace trapeze::rib
