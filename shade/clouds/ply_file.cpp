#include "shade/clouds/ply_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/files/picture_files.h"
#include "shade/clouds/little_bytes.h"
#include "shade/clouds/ply_header.h"

namespace trapeze {
namespace {

constexpr const char* kPlainNames[] = {"x", "y", "z", "nx", "ny", "nz", "radius"};

std::string header_of(const PointCloud& cloud, bool ascii) {
    std::string text =
        fmt::format("ply\nformat {} 1.0\n{}\n", ascii ? "ascii" : "binary_little_endian", kCloudComment);
    for (const CloudChannel& channel : cloud.channels)
        if (channel.type != ChannelType::Matrix)
            text += fmt::format("comment channel {} {}\n", name_of(channel.type), channel.name);
    text += fmt::format("element vertex {}\n", cloud.size());
    for (const char* const name : kPlainNames) text += fmt::format("property float {}\n", name);
    for (const CloudChannel& channel : cloud.channels)
        for (const std::string& name : ply_properties_of(channel))
            text += fmt::format("property float {}\n", name);
    return text + "end_header\n";
}

/// A point's numbers, in the order of the header.
void numbers_of(const PointCloud& cloud, size_t i, std::vector<float>& numbers) {
    const V3f &p = cloud.positions[i], &n = cloud.normals[i];
    numbers.assign({p.x, p.y, p.z, n.x, n.y, n.z, cloud.radii[i]});
    const float* value = cloud.values.data() + i * cloud.floats_per_point();
    for (const CloudChannel& channel : cloud.channels) {
        const int floats = floats_of(channel.type);
        if (channel.type != ChannelType::Matrix) numbers.insert(numbers.end(), value, value + floats);
        value += floats;
    }
}

/// Takes a number of a type, in bytes.
double take(ByteReader& reader, PlyType type) {
    switch (type) {
        case PlyType::Int8:
            return reader.take<int8_t>();
        case PlyType::Uint8:
            return reader.take<uint8_t>();
        case PlyType::Int16:
            return reader.take<int16_t>();
        case PlyType::Uint16:
            return reader.take<uint16_t>();
        case PlyType::Int32:
            return reader.take<int32_t>();
        case PlyType::Uint32:
            return reader.take<uint32_t>();
        case PlyType::Float:
            return reader.take<float>();
        case PlyType::Double:
            return reader.take<double>();
    }
    return 0;
}

/// Takes a number that is written out; false where there is none.
bool take_word(std::string_view& text, double* number) {
    const size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return false;
    text.remove_prefix(first + (text[first] == '+'));
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *number);
    if (error == std::errc::result_out_of_range) *number = std::numeric_limits<double>::quiet_NaN();
    if (error == std::errc::invalid_argument) return false;
    text.remove_prefix(static_cast<size_t>(end - text.data()));
    return text.empty() || text.find_first_of(" \t\r\n") == 0;
}

/// Puts the numbers of a point, in the order of the file, to their places.
void add_point(const PlyHeader& header, const std::vector<double>& numbers, PointCloud& cloud) {
    const auto number = [&](int property) {
        return property < 0 ? 0.0f : static_cast<float>(numbers[static_cast<size_t>(property)]);
    };
    const auto triple = [&](const std::array<int, 3>& at) {
        return V3f(number(at[0]), number(at[1]), number(at[2]));
    };
    cloud.positions.push_back(triple(header.position));
    const V3f normal = triple(header.normal);
    const bool finite = std::isfinite(normal.x) && std::isfinite(normal.y) && std::isfinite(normal.z);
    cloud.normals.push_back(finite ? normal.normalized() : V3f(0));
    cloud.radii.push_back(number(header.radius));
    for (const PlyValue& value : header.values)
        cloud.values.push_back(
            static_cast<float>(numbers[static_cast<size_t>(value.property)] / value.divisor));
}

}  // namespace

bool is_ply(std::string_view bytes) {
    return bytes.starts_with("ply\n") || bytes.starts_with("ply\r\n");
}

bool write_ply(const PointCloud& cloud, bool ascii, const CloudSink& sink) {
    std::string bytes = header_of(cloud, ascii);
    std::vector<float> numbers;
    for (size_t i = 0; i < cloud.size(); ++i) {
        numbers_of(cloud, i, numbers);
        for (size_t k = 0; k < numbers.size(); ++k)
            if (ascii)
                bytes += fmt::format("{}{}", numbers[k], k + 1 < numbers.size() ? ' ' : '\n');
            else
                put_little(bytes, numbers[k]);
        if (bytes.size() < kCloudBytesAtOnce) continue;
        if (!sink(bytes)) return false;
        bytes.clear();
    }
    return sink(bytes);
}

std::optional<PointCloud> read_ply(std::string_view bytes, std::string* problem) {
    PlyHeader header;
    *problem = read_ply_header(bytes, &header);
    if (!problem->empty()) return {};
    std::string_view rest = bytes.substr(header.bytes);
    const bool ascii = header.form == PlyHeader::Form::Ascii;
    // A number that is written out takes a digit and what parts it from the next.
    const size_t least = ascii ? 2 * header.properties.size() : header.stride;
    const size_t there = (rest.size() + ascii) / least;
    if (header.points > there) {
        *problem =
            fmt::format("it says that it has {} points, and has no more than {}", header.points, there);
        return {};
    }
    PointCloud cloud;
    cloud.channels = header.channels;
    ByteReader reader(rest, header.form == PlyHeader::Form::BigEndian);
    std::vector<double> numbers(header.properties.size());
    for (uint64_t i = 0; i < header.points; ++i) {
        for (size_t k = 0; k < numbers.size(); ++k) {
            if (!ascii) {
                numbers[k] = take(reader, header.properties[k].type);
            } else if (!take_word(rest, &numbers[k])) {
                *problem = fmt::format("its point {} has no number for \"{}\"", i + 1,
                                       header.properties[k].name.substr(0, 80));
                return {};
            }
        }
        add_point(header, numbers, cloud);
    }
    return cloud;
}

}  // namespace trapeze
