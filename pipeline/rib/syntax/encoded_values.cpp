#include "pipeline/rib/syntax/encoded_values.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "pipeline/rib/syntax/encoding_bytes.h"

namespace trapeze::rib {
namespace {

/// Most significant byte first; bytes that are not there count as 0.
uint64_t big_endian(std::string_view bytes, size_t begin, size_t count) {
    uint64_t value = 0;
    for (size_t i = 0; i < count; ++i)
        value = value << 8 | (begin + i < bytes.size() ? static_cast<unsigned char>(bytes[begin + i]) : 0);
    return value;
}

}  // namespace

/// The length of a string or an array may be any 32-bit number here: who reads it compares it with the bytes
/// that there are.
EncodedValue encoded_value(std::string_view bytes) {
    const unsigned first = static_cast<unsigned char>(bytes[0]), width = (first & 3) + 1;
    if (first < kShortStringByte) return {Encoding::Number, 1 + width, 1};
    if (first < kLongStringByte) return {Encoding::String, 1 + (first & 15), 1};
    if (first < kFloatByte) return {Encoding::String, 1 + width + big_endian(bytes, 1, width), 1 + width};
    if (first == kFloatByte) return {Encoding::Float, 1 + 4, 1};
    if (first == kDoubleByte) return {Encoding::Double, 1 + 8, 1};
    if (first == kRequestByte) return {Encoding::Request, 2, 1};
    if (first < kFloatsByte) return {};
    if (first < kDefineRequestByte)
        return {Encoding::Floats, 1 + width + 4 * big_endian(bytes, 1, width), 1 + width};
    if (first == kDefineRequestByte) return {Encoding::DefineRequest, 2, 1};
    if (first < kDefinedStringByte) return {Encoding::DefineString, 2 + first - kDefineStringByte, 1};
    if (first <= kDefinedStringByte + 1) return {Encoding::DefinedString, 2 + first - kDefinedStringByte, 1};
    return {};
}

/// Integers are two's complement; fixed-point numbers are integers with so many bytes behind the point.
/// Shifted up and down again as a signed number, the sign's bit is spread over the bytes that the value does
/// not have.
double decoded_number(const EncodedValue& value, std::string_view bytes) {
    const unsigned first = static_cast<unsigned char>(bytes[0]);
    if (value.encoding == Encoding::Float)
        return static_cast<double>(std::bit_cast<float>(static_cast<uint32_t>(big_endian(bytes, 1, 4))));
    if (value.encoding == Encoding::Double) {
        const double number = std::bit_cast<double>(big_endian(bytes, 1, 8));
        return std::isfinite(static_cast<float>(number)) ? number : std::numeric_limits<double>::infinity();
    }
    const unsigned width = (first & 3) + 1, fraction = first >> 2 & 3;
    const auto aligned = static_cast<int64_t>(big_endian(bytes, 1, width) << (64 - 8 * width));
    return std::ldexp(static_cast<double>(aligned >> (64 - 8 * width)), -8 * static_cast<int>(fraction));
}

/// All that follows the first byte is the code: one byte for requests, one or more for strings.
unsigned decoded_code(const EncodedValue& value, std::string_view bytes) {
    return static_cast<unsigned>(big_endian(bytes, 1, static_cast<size_t>(value.length) - 1));
}

/// The loop has no branches, so that it is made of vector instructions: an exponent of all ones (infinite,
/// NaN) leaves no headroom, and the least of all tells whether there was one.
bool append_floats(std::string_view contents, std::vector<float>& floats) {
    const size_t old = floats.size(), count = contents.size() / 4;
    floats.resize(old + count);
    uint32_t least_headroom = ~uint32_t{0};
    for (size_t i = 0; i < count; ++i) {
        uint32_t bits;
        std::memcpy(&bits, contents.data() + 4 * i, 4);
        if constexpr (std::endian::native == std::endian::little) bits = __builtin_bswap32(bits);
        const uint32_t headroom = 0x7f800000u - (bits & 0x7f800000u);  // 0: infinite or NaN
        least_headroom = headroom < least_headroom ? headroom : least_headroom;
        std::memcpy(floats.data() + old + i, &bits, 4);
    }
    return least_headroom > 0;
}

}  // namespace trapeze::rib
