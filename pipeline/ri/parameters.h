/// Parameter lists of calls: C arrays whose lengths follow from their declarations and from the primitive.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/scene/shapes.h"
#include "pipeline/ri/context.h"

namespace trapeze::ri {

/// One that will be written. The values are the caller's still.
struct RiParameter {
    std::string token;  ///< as the caller wrote it, with its declaration if it has one
    ValueType type = ValueType::Float;
    const void* values = nullptr;  ///< `count` of float, int or RtString
    size_t count = 0;
};

struct RiArguments {
    RtInt count;
    RtToken* tokens;
    RtPointer* values;
};

/// Those whose tokens are known; others are complained of and left out. `category` is the name of an option
/// or attribute, whose usual values need no declaration, or empty.
std::vector<RiParameter> checked_parameters(Context& context, const RiArguments& arguments,
                                            const VariableCounts& counts, const std::string& category = {});
inline std::vector<RiParameter> checked_parameters(Context& context, const RiArguments& arguments,
                                                   const std::string& category = {}) {
    return checked_parameters(context, arguments, VariableCounts{}, category);
}

void write_parameters(rib::RibWriter& writer, const std::vector<RiParameter>& parameters);

/// Arrays as std::span: RIE_RANGE for a negative count, RIE_MISSINGDATA for null unless the count is 0.
template <class T>
std::span<const T> array_of(const T* values, int64_t count, const char* what) {
    if (count < 0) throw CallError{RIE_RANGE, std::string("the number of ") + what + " is negative"};
    if (count == 0) return {};
    return {required(values, what), static_cast<size_t>(count)};
}

/// The same of strings, none of which may be null.
std::vector<std::string> strings_of(const RtString* values, int64_t count, const char* what);

/// RIE_RANGE where one is below `least`, or the sum is not an int.
int sum_of(std::span<const int> counts, int least, const char* what);

}  // namespace trapeze::ri
