/// RISpec's binary encoding (appendix C.2, table C.1): values and requests that begin with a byte above 0177
/// and may stand wherever text may.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace trapeze::rib {

/// What the first byte of a value says of it.
enum class Encoding : uint8_t {
    Number,  ///< integers and fixed-point numbers
    String,
    Float,
    Double,
    Request,        ///< by its code
    Floats,         ///< an array
    DefineRequest,  ///< a code; the name follows as a string
    DefineString,   ///< likewise
    DefinedString,  ///< by its code
    None,           ///< RISpec reserves the byte
};

/// A value's kind and extent, known from its first bytes alone; its contents follow the header.
struct EncodedValue {
    Encoding encoding = Encoding::None;
    /// Bytes of the value with its first one; of definitions without the string. May be more than there are.
    uint64_t length = 1;
    size_t header = 1;  ///< bytes before the contents
};

/// What stands at the beginning of bytes, the first of which is above 0177.
EncodedValue encoded_value(std::string_view bytes);

/// A Number, Float or Double, whole. Infinite when it is no finite float.
double decoded_number(const EncodedValue& value, std::string_view bytes);

/// The codes of a Request, of a string, or of their definitions.
unsigned decoded_code(const EncodedValue& value, std::string_view bytes);

/// Appends the contents of an array of floats; false when some are not finite.
bool append_floats(std::string_view contents, std::vector<float>& floats);

/// What a stream has defined. Codes are defined by the stream itself, as it goes; a later definition of a
/// code replaces the earlier one.
struct EncodedNames {
    std::map<unsigned, std::string> requests, strings;
};

/// The longest string that may have a code: each use of it copies it.
inline constexpr size_t kLongestEncodedName = 4096;

}  // namespace trapeze::rib
