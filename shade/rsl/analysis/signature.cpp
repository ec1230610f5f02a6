#include "shade/rsl/analysis/signature.h"

#include "shade/rsl/syntax/printer.h"

namespace trapeze::rsl {
namespace {

/// A letter of Builtin::parameters, small or capital: setting bit 5 of an ASCII letter makes it small. Void
/// for "w" and for all that is no type.
Base base_of(char letter) {
    switch (letter | 32) {
        case 'f':
            return Base::Float;
        case 'c':
            return Base::Color;
        case 'p':
            return Base::Point;
        case 'v':
            return Base::Vector;
        case 'n':
            return Base::Normal;
        case 'm':
            return Base::Matrix;
        case 's':
            return Base::String;
        default:
            return Base::Void;
    }
}

}  // namespace

/// Reads the row's letters from left to right; "[" changes the parameter before it. See Builtin for them.
/// Capital letters are output parameters.
Signature signature_of(const Builtin& builtin) {
    Signature signature;
    signature.name = builtin.name;
    signature.result.base = base_of(builtin.result);
    signature.builtin = &builtin;
    for (const char c : builtin.parameters) {
        if (c == '[')
            signature.parameters.back().type.length = Type::kUnsized;
        else if (c == '*')
            signature.pairs = true;
        else if (c == '+')
            signature.more = true;
        else if (c == '.')
            signature.anything = true;
        else if (c == '?')
            signature.parameters.push_back({{}, true, true, false});
        else if (c == '#')
            signature.parameters.push_back({{}, false, false, true});
        else
            signature.parameters.push_back({{base_of(c), 0}, c < 'a', false, false});
    }
    return signature;
}

/// Of a function of the source: as many arguments as it has parameters, without those that have default
/// values. Views point into the function, which outlives the signature.
Signature signature_of(const Function& function) {
    Signature signature;
    signature.name = function.name;
    signature.result = function.result;
    signature.function = &function;
    for (const auto& parameter : function.parameters)
        signature.parameters.push_back({parameter->type, parameter->output, false, false});
    signature.hidden = function.hidden;
    for (size_t i = function.parameters.size(); i-- > 0 && function.parameters[i]->initial;)
        ++signature.optional;
    return signature;
}

/// A signature as messages show it: with "..." where more arguments may follow. Close to RISpec's own way to
/// write functions, which readers of messages know.
std::string print(const Signature& signature) {
    std::string text = print(signature.result) + " " + std::string(signature.name) + "(";
    const char* separator = "";
    for (size_t i = signature.hidden; i < signature.parameters.size(); ++i) {
        const Signature::Parameter& parameter = signature.parameters[i];
        text += std::string(separator) + (parameter.output ? "output " : "") +
                (parameter.any         ? "any type"
                 : parameter.any_array ? "any array"
                                       : print(parameter.type));
        if (i >= signature.parameters.size() - signature.optional)
            text += " = " + print(*signature.function->parameters[i]->initial);
        separator = ", ";
    }
    if (signature.more || signature.anything) text += std::string(separator) + "...";
    if (signature.pairs) text += std::string(separator) + "\"name\", value, ...";
    return text + ")";
}

}  // namespace trapeze::rsl
