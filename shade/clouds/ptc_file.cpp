#include "shade/clouds/ptc_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/portable_math.h"
#include "shade/clouds/little_bytes.h"

namespace trapeze {
namespace {

constexpr std::string_view kMagic = "pptc";
constexpr int kNewest = 2;
constexpr double kSteps = 65535, kPiExact = std::numbers::pi;
constexpr uint16_t kNone = 65535;
constexpr size_t kMostInPtcLine = 256;
constexpr size_t kPlainBytes = 3 * 4 + 2 * 2 + 4;  ///< of a point without channels

/// The two numbers that stand for a normal.
struct PackedNormal {
    uint16_t angle = kNone, height = kNone;
};

PackedNormal packed(const V3f& n) {
    const double x = n.x, y = n.y, z = n.z, length = std::sqrt(x * x + y * y + z * z);
    if (!(length > 0)) return {};
    const double turn = portable::atan2(x, y) / (2 * kPiExact) + 0.5, height = (z / length + 1) / 2;
    PackedNormal packed{static_cast<uint16_t>(turn * kSteps + 0.5),
                        static_cast<uint16_t>(std::min(height * kSteps + 0.5, kSteps))};
    // The angle does not matter where the normal is upright: this is not the sign for no normal.
    if (packed.angle == kNone && packed.height == kNone) packed.angle = 0;
    return packed;
}

V3f unpacked(const PackedNormal& packed) {
    if (packed.angle == kNone && packed.height == kNone) return V3f(0);
    const double z = 2 * (packed.height / kSteps) - 1, beside = std::sqrt(std::max(0.0, 1 - z * z));
    const double angle = 2 * kPiExact * (packed.angle / kSteps - 0.5);
    return V3f(static_cast<float>(beside * portable::sin(angle)),
               static_cast<float>(beside * portable::cos(angle)), static_cast<float>(z));
}

void put(std::string& bytes, const V3f& v) {
    for (int k = 0; k < 3; ++k) put_little(bytes, v[k]);
}
void put(std::string& bytes, const M44f& m) {
    for (int i = 0; i < 16; ++i) put_little(bytes, m[i / 4][i % 4]);
}

V3f take_triple(ByteReader& reader) {
    V3f v;
    for (int k = 0; k < 3; ++k) v[k] = reader.take<float>();
    return v;
}

std::string header(const PointCloud& cloud, const CloudView& view) {
    std::string bytes(kMagic);
    put_little(bytes, int32_t{0});
    put_little(bytes, static_cast<double>(cloud.size()));
    const Box3f box = cloud.bounds();
    put(bytes, box.min), put(bytes, box.max);
    put(bytes, view.camera_from_world), put(bytes, view.screen_from_camera);
    for (const float side : {view.width, view.height, 1.0f}) put_little(bytes, side);
    put_little(bytes, static_cast<int32_t>(cloud.channels.size()));
    put_little(bytes, static_cast<int32_t>(cloud.floats_per_point()));
    for (const CloudChannel& channel : cloud.channels)
        bytes += fmt::format("{} {}\n", name_of(channel.type), channel.name);
    return bytes;
}

/// The channel of a line "color _name"; false where it is none.
bool read_channel(std::string_view line, CloudChannel* channel) {
    const size_t space = line.find(' ');
    if (space == std::string_view::npos) return false;
    const size_t name = line.find_first_not_of(' ', space);
    if (name == std::string_view::npos) return false;
    channel->name = line.substr(name);
    return channel_type_named(line.substr(0, space), &channel->type) && is_channel_name(channel->name);
}

/// The lines of the channels; what is wrong with them, or nothing.
std::string read_channels(ByteReader& reader, PointCloud& cloud) {
    const int32_t count = reader.take<int32_t>(), floats = reader.take<int32_t>();
    if (count < 0 || static_cast<size_t>(count) > kMostChannels)
        return fmt::format("it says that it has {} channels", count);
    for (int32_t i = 0; i < count; ++i) {
        CloudChannel channel;
        if (!read_channel(reader.line(kMostInPtcLine), &channel))
            return fmt::format("its channel {} has no type and name that are known", i + 1);
        cloud.channels.push_back(std::move(channel));
    }
    if (floats < 0 || static_cast<size_t>(floats) != cloud.floats_per_point())
        return fmt::format("its channels have {} numbers where it says {}", cloud.floats_per_point(), floats);
    return {};
}

void read_points(ByteReader& reader, size_t count, PointCloud& cloud) {
    const size_t floats = cloud.floats_per_point();
    cloud.positions.reserve(count), cloud.normals.reserve(count), cloud.radii.reserve(count);
    cloud.values.reserve(count * floats);
    for (size_t i = 0; i < count; ++i) {
        cloud.positions.push_back(take_triple(reader));
        const uint16_t angle = reader.take<uint16_t>(), height = reader.take<uint16_t>();
        cloud.normals.push_back(unpacked({angle, height}));
        cloud.radii.push_back(reader.take<float>());
        for (size_t k = 0; k < floats; ++k) cloud.values.push_back(reader.take<float>());
    }
}

}  // namespace

bool is_ptc(std::string_view bytes) {
    return bytes.starts_with(kMagic);
}

bool write_ptc(const PointCloud& cloud, const CloudView& view, const CloudSink& sink) {
    std::string bytes = header(cloud, view);
    const size_t floats = cloud.floats_per_point();
    for (size_t i = 0; i < cloud.size(); ++i) {
        put(bytes, cloud.positions[i]);
        const PackedNormal normal = packed(cloud.normals[i]);
        put_little(bytes, normal.angle), put_little(bytes, normal.height);
        put_little(bytes, cloud.radii[i]);
        for (size_t k = 0; k < floats; ++k) put_little(bytes, cloud.values[i * floats + k]);
        if (bytes.size() < kCloudBytesAtOnce) continue;
        if (!sink(bytes)) return false;
        bytes.clear();
    }
    return sink(bytes);
}

std::optional<PointCloud> read_ptc(std::string_view bytes, std::string* problem) {
    const auto fail = [&](std::string why) {
        *problem = std::move(why);
        return std::nullopt;
    };
    if (!is_ptc(bytes)) return fail("it is no point cloud");
    ByteReader reader(bytes.substr(kMagic.size()));
    const int32_t version = reader.take<int32_t>();
    if (version < 0 || version > kNewest)
        return fail(fmt::format("it is of version {}; {} is the newest that is known", version, kNewest));
    const double count = reader.take<double>();
    reader.skip(6 * sizeof(float));
    if (version >= 1) reader.skip(4 * sizeof(float));
    if (version >= 2) reader.skip(33 * sizeof(float));
    reader.skip((16 + 16 + 3) * sizeof(float));
    PointCloud cloud;
    if (std::string wrong = read_channels(reader, cloud); !reader.ended() && !wrong.empty())
        return fail(std::move(wrong));
    if (version >= 1) reader.skip(2 * sizeof(float));
    if (reader.ended()) return fail("its header is cut short");
    const size_t stride = kPlainBytes + cloud.floats_per_point() * sizeof(float);
    const size_t there = reader.left().size() / stride;
    if (!(count >= 0) || count != std::floor(count) || count > static_cast<double>(there))
        return fail(fmt::format("it says that it has {:.0f} points, and has {}", count, there));
    read_points(reader, static_cast<size_t>(count), cloud);
    return cloud;
}

}  // namespace trapeze
