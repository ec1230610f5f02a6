/// Calls as other renderers have them, in the forms that are known here.
#include <algorithm>

#include "shade/rsl/analysis/analyser.h"

namespace trapeze::rsl {
namespace {

/// The object that getvar(null, ...) asks: the one that is shaded.
bool is_null(const Expression& e) {
    return e.kind == Expression::Kind::Variable && e.text == "null";
}

}  // namespace

/// Whether a call is trace(P, R, distance, ...) of 3Delight, and of no function of the source.
bool Analyser::sets_distance(const Expression& call) {
    if (call.children.size() < 3 || candidates(call).front().function) return false;
    Expression& third = *call.children[2];
    possible_types_once(third);
    return is_place(third) && third.type == Type{Base::Float};
}

/// outputchannel("name", value) of 3Delight becomes name = value, where the shader has such an output: what
/// is shown is what shaders declare. Else the value alone is left.
void Analyser::write_output(Expression& call) {
    const Expression& name = *call.children[0];
    const bool is_text = name.kind == Expression::Kind::Text;
    Variable* output = nullptr;
    for (const auto& parameter : shader_->parameters)
        if (is_text && parameter->output && parameter->name == name.text) output = parameter.get();
    // Functions know it from here on, as by "extern".
    if (output && bodies_.size() > 1 && !find_variable(output->name))
        scopes_.back().variables[output->name] = output;
    const SourceLocation at = call.at;
    ExpressionPtr value = std::move(call.children[1]);
    if (!output || find_variable(output->name) != output) {
        reporter_.warning(at, is_text ? "the shader has no output \"" + name.text.substr(0, 80) +
                                            "\" here: outputchannel() does nothing"
                                      : "outputchannel() without a text for a name does nothing");
        Expression inner = std::move(*value);
        call = std::move(inner);
        return;
    }
    auto place = std::make_unique<Expression>();
    place->kind = Expression::Kind::Variable, place->text = output->name, place->at = at;
    call.kind = Expression::Kind::Assignment;
    call.text.clear();
    call.children.clear();
    call.children.push_back(std::move(place));
    call.children.push_back(std::move(value));
}

/// Calls of other renderers' forms become those that are known: print(x) of its type's printf(),
/// specularstd() of 3Delight, whose exponent is not eight times as large, the distance that its trace() sets
/// gets a name, and the points behind the "source" of a shadow are left out, as for a source that is a point.
void Analyser::write_as_known(Expression& call) {
    std::vector<ExpressionPtr>& arguments = call.children;
    if (call.text == "outputchannel" && arguments.size() == 2 && candidates(call).empty())
        return write_output(call);
    if (call.text == "getvar" && arguments.size() == 3 && is_null(*arguments[0]))
        arguments.erase(arguments.begin());
    if (call.text == "trace" && arguments.size() % 2 == 1 && sets_distance(call)) {
        auto name = std::make_unique<Expression>();
        name->kind = Expression::Kind::Text, name->at = arguments[2]->at;
        name->text = "hitdist";
        arguments.insert(arguments.begin() + 2, std::move(name));
    }
    if (call.text == "print" && arguments.size() == 1 && candidates(call).empty()) {
        const Choices type = possible_types_once(*arguments[0]);
        auto format = std::make_unique<Expression>();
        format->kind = Expression::Kind::Text, format->at = call.at;
        format->text = type.has(Base::String)   ? "%s\n"
                       : type.has(Base::Float)  ? "%f\n"
                       : type.has(Base::Matrix) ? "%m\n"
                       : type.has(Base::Color)  ? "%c\n"
                                                : "%p\n";
        arguments.insert(arguments.begin(), std::move(format));
        call.text = "printf";
    }
    if (call.text == "specularstd" && arguments.size() == 3 && candidates(call).empty()) {
        auto eight = std::make_unique<Expression>();
        eight->kind = Expression::Kind::Number, eight->at = call.at, eight->number = 8;
        auto times = std::make_unique<Expression>();
        times->kind = Expression::Kind::Binary, times->op = Operator::Multiply, times->at = call.at;
        times->children.push_back(std::move(arguments[2]));
        times->children.push_back(std::move(eight));
        arguments[2] = std::move(times);
        for (size_t i = 0; i < 2; ++i) {
            auto unit = std::make_unique<Expression>();
            unit->kind = Expression::Kind::Call, unit->text = "normalize", unit->at = call.at;
            unit->children.push_back(std::move(arguments[i]));
            arguments[i] = std::move(unit);
        }
        call.text = "specular";
    }
    if (call.text != "shadow") return;
    const auto is_text = [](const ExpressionPtr& e) { return e->kind == Expression::Kind::Text; };
    const auto source = std::find_if(arguments.begin(), arguments.end(), [&](const ExpressionPtr& e) {
        return is_text(e) && e->text == "source" && &e != &arguments.front();
    });
    const auto end = source == arguments.end() ? source : std::find_if(source + 1, arguments.end(), is_text);
    if (end - source <= 2) return;  // one value is an argument as others are
    reporter_.warning((*source)->at,
                      "a \"source\" of several points is not supported: shadows are those of a point");
    arguments.erase(source, end);
}

}  // namespace trapeze::rsl
