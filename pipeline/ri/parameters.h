/// Parameter lists of calls: C arrays whose lengths follow from their declarations and from the primitive.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/scene/shapes.h"
#include "pipeline/ri/context.h"

namespace trapeze::ri {

/// A parameter that will be written. The values stay the caller's.
struct RiParameter {
    std::string token;  ///< as the caller wrote it, with its declaration if it has one
    ValueType type = ValueType::Float;
    const void* values = nullptr;  ///< `count` of float, int or RtString
    size_t count = 0;
};

/// A call's parameter list as RISpec's V forms have it: `count` tokens and as many pointers to values.
struct RiArguments {
    RtInt count;
    RtToken* tokens;
    RtPointer* values;
};

/// The parameters whose tokens are known; others are complained of and left out. `counts` are the
/// primitive's, from which the lengths follow. `category` is the name of an option or attribute, whose usual
/// values need no declaration, or empty.
std::vector<RiParameter> checked_parameters(Context& context, const RiArguments& arguments,
                                            const VariableCounts& counts, const std::string& category = {});
inline std::vector<RiParameter> checked_parameters(Context& context, const RiArguments& arguments,
                                                   const std::string& category = {}) {
    return checked_parameters(context, arguments, VariableCounts{}, category);
}

/// Writes the list behind a request's other arguments.
void write_parameters(rib::RibWriter& writer, const std::vector<RiParameter>& parameters);

/// An array argument as std::span. Throws RIE_RANGE for a negative count, and RIE_MISSINGDATA for null unless
/// the count is 0; messages call it `what`.
template <class T>
std::span<const T> array_of(const T* values, int64_t count, const char* what) {
    if (count < 0) throw CallError{RIE_RANGE, std::string("the number of ") + what + " is negative"};
    if (count == 0) return {};
    return {required(values, what), static_cast<size_t>(count)};
}

/// An array of strings; throws as array_of() does, and for a string that is null.
std::vector<std::string> strings_of(const RtString* values, int64_t count, const char* what);

/// The sum of counts. Throws RIE_RANGE where one is below `least`, or the sum is not an int.
int sum_of(std::span<const int> counts, int least, const char* what);

}  // namespace trapeze::ri
