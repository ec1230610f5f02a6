/// Point clouds from strangers: the bytes are a file's, of either format; what is read of them is looked into
/// at a few places, and written and read again. Built and replayed as rib_fuzz.cpp is, with
/// tests/fuzz/seeds/cloud as corpus.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "shade/clouds/cloud_library.h"
#include "shade/clouds/ply_file.h"
#include "shade/clouds/ptc_file.h"

namespace {

using namespace trapeze;

void require(bool holds) {
    if (!holds) std::abort();
}

/// Planes have a value for each point, and no more points than the file has bytes for.
void check(const PointCloud& cloud, size_t bytes) {
    require(cloud.size() <= bytes);
    require(cloud.normals.size() == cloud.size() && cloud.radii.size() == cloud.size());
    require(cloud.values.size() == cloud.size() * cloud.floats_per_point());
    require(cloud.channels.size() <= kMostChannels);
    for (const CloudChannel& channel : cloud.channels) require(is_channel_name(channel.name));
}

/// Weights are of points that are there, and together 1.
void look_into(const PointCloud& cloud) {
    const CloudTree tree(cloud);
    std::vector<CloudShare> shares;
    for (const float radius : {0.0f, 1.0f, 1e30f})
        for (size_t i = 0; i < cloud.size() && i < 5; ++i) {
            tree.find({cloud.positions[i], cloud.normals[i / 2], radius, i % 2 ? 1.0f : .3f}, shares);
            double sum = shares.empty() ? 1 : 0;
            for (const CloudShare& share : shares) {
                require(share.point < cloud.size());
                sum += share.weight;
            }
            require(std::abs(sum - 1) < 1e-9);
        }
}

/// What has been read can be written, and is the same when it is read again, but for PLY's matrices.
void write_and_read(const PointCloud& cloud) {
    std::string bytes, problem;
    const CloudSink sink = [&](std::string_view more) {
        bytes += more;
        return true;
    };
    require(write_ptc(cloud, {}, sink));
    const auto ptc = read_point_cloud(bytes, &problem);
    require(ptc && ptc->channels == cloud.channels && ptc->size() == cloud.size());
    for (const bool ascii : {false, true}) {
        bytes.clear();
        require(write_ply(cloud, ascii, sink));
        const auto ply = read_point_cloud(bytes, &problem);
        require(ply && ply->size() == cloud.size() && ply->channels.size() <= cloud.channels.size());
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    std::string problem;
    const auto cloud = read_point_cloud(bytes, &problem);
    require(cloud.has_value() == problem.empty());
    if (!cloud) return 0;
    check(*cloud, size);
    look_into(*cloud);
    write_and_read(*cloud);
    return 0;
}
