/// The expressions of IfBegin and ElseIf, which RISpec 3.2 does not have: PRMan's and Pixie's common
/// language.
///
///     $user:pass == 'beauty' && (defined(Option:user:quality) || !$Attribute:user:draft)
///
/// Numbers, 'strings', [arrays of numbers], $name, ${name} and $(expression giving a name); * / + -;
/// == != < <= > >= and =~ (the right side is a POSIX extended regular expression); ! && ||; defined(name);
/// concat(a, b, ...); parentheses.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trapeze::rib {

/// Numbers (1 or more) or a text; a variable that nobody set has neither, equals nothing and is false.
struct ConditionValue {
    std::vector<double> numbers;
    std::optional<std::string> text;

    bool is_undefined() const { return numbers.empty() && !text; }
};

/// What a name without its $ stands for.
using ConditionVariables = std::function<ConditionValue(const std::string& name)>;

/// What evaluate_condition() found; it throws nothing, as a wrong condition is an error of the file's.
struct ConditionResult {
    bool holds = false;
    std::string problem;                 ///< why there is no result; empty when all is well
    std::vector<std::string> undefined;  ///< variables whose values were asked for in vain
};

/// Calls `variables` for each name, in no order to rely on, and more than once where a name is repeated.
ConditionResult evaluate_condition(std::string_view expression, const ConditionVariables& variables);

/// `text` with $name and ${name} replaced by their values, `marker` standing for $. Names nobody knows stay
/// as they are.
std::string substitute_variables(const std::string& text, const std::string& marker,
                                 const ConditionVariables& variables);

/// How a value looks in a text: numbers by their shortest form, apart by spaces.
std::string text_of(const ConditionValue& value);

}  // namespace trapeze::rib
