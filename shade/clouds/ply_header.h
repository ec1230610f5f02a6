/// The header of a PLY file: which of its numbers are what of a point.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "shade/clouds/point_cloud.h"

namespace trapeze {

enum class PlyType : uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float, Double };

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float;
};

/// One number of a channel: the property that it is, and what it is divided by.
struct PlyValue {
    int property = 0;
    double divisor = 1;
};

struct PlyHeader {
    enum class Form : uint8_t { Ascii, LittleEndian, BigEndian };
    Form form = Form::Ascii;
    size_t bytes = 0;  ///< of the header
    uint64_t points = 0;
    std::vector<PlyProperty> properties;
    size_t stride = 0;                                            ///< bytes of a point in binary
    std::array<int, 3> position{-1, -1, -1}, normal{-1, -1, -1};  ///< properties; -1: not there
    int radius = -1;
    std::vector<CloudChannel> channels;
    std::vector<PlyValue> values;  ///< of the channels, in their order
};

/// The properties under which a channel is written; none for a matrix.
std::vector<std::string> ply_properties_of(const CloudChannel& channel);

/// Returns what is wrong, or nothing.
std::string read_ply_header(std::string_view bytes, PlyHeader* header);

}  // namespace trapeze
