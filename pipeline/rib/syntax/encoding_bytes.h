/// The first bytes of RISpec's binary encoding (appendix C.2, table C.1), for the reader and the writer.
#pragma once

namespace trapeze::rib {

/// Octal as in the table. Most have a count added, which is that of bytes unless said otherwise, and which
/// never reaches the next byte of the list.
enum EncodingByte : unsigned {
    kIntegerByte = 0200,        ///< + 4 * bytes of fraction + bytes - 1; big-endian, two's complement
    kShortStringByte = 0220,    ///< + length, below 16
    kLongStringByte = 0240,     ///< + bytes of the length - 1
    kFloatByte = 0244,          ///< then 4 bytes, big-endian
    kDoubleByte = 0245,         ///< then 8
    kRequestByte = 0246,        ///< then the request's code
    kFloatsByte = 0310,         ///< an array: + bytes of the number of floats - 1
    kDefineRequestByte = 0314,  ///< then a code, then the name as a string
    kDefineStringByte = 0315,   ///< + bytes of the code - 1; then the code and the string
    kDefinedStringByte = 0317,  ///< + bytes of the code - 1; then the code
};

}  // namespace trapeze::rib
