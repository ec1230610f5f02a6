#include "shade/clouds/cloud_library.h"

#include <fmt/format.h>

#include "shade/clouds/cloud_surfels.h"
#include "shade/clouds/ply_file.h"
#include "shade/clouds/ptc_file.h"
#include "shade/maps/texture_files.h"

namespace trapeze {

std::optional<PointCloud> read_point_cloud(std::string_view bytes, std::string* problem) {
    return is_ply(bytes) ? read_ply(bytes, problem) : read_ptc(bytes, problem);
}

const CloudChannel* LoadedCloud::find(std::string_view name, size_t* first) const {
    *first = 0;
    for (const CloudChannel& channel : cloud.channels) {
        if (channel.name == name) return &channel;
        *first += static_cast<size_t>(floats_of(channel.type));
    }
    return nullptr;
}

size_t LoadedCloud::bytes() const {
    return (cloud.positions.capacity() + cloud.normals.capacity()) * sizeof(V3f) +
           (cloud.radii.capacity() + cloud.values.capacity()) * sizeof(float) + tree.bytes();
}

CloudLibrary::CloudLibrary(const Options& options, Diagnostics* diagnostics, const Access& access)
    : diagnostics_(diagnostics), access_(access) {
    if (const auto paths = options.search_paths.find("texture"); paths != options.search_paths.end())
        folders_ = paths->second;
}

std::string CloudLibrary::too_large() const {
    return fmt::format("with the others it takes more than the {} MiB that clouds may take", limit_ >> 20);
}

/// Reads a cloud; returns what is wrong, or nothing.
std::string CloudLibrary::load(const std::string& name, std::unique_ptr<const LoadedCloud>& cloud) {
    const auto file = map_file(name, folders_, access_);
    if (!file) return access_.is_closed(name) ? Access::kClosed : "there is no such file";
    std::string bytes, problem;
    // What is read takes about as much again as its file.
    if (!access_.read(*file, (limit_ - bytes_) / 2, &bytes))
        return bytes.size() > (limit_ - bytes_) / 2 ? too_large() : "it cannot be read";
    auto read = read_point_cloud(bytes, &problem);
    bytes = {};
    if (!read) return problem;
    auto loaded = std::make_unique<const LoadedCloud>(std::move(*read));
    if (loaded->bytes() > limit_ - bytes_) return too_large();
    bytes_ += loaded->bytes();
    cloud = std::move(loaded);
    return {};
}

/// What is known of a file, which is read now if it has not been. To be called with the lock.
CloudLibrary::Entry& CloudLibrary::entry(const std::string& name) {
    const auto [found, is_new] = clouds_.try_emplace(name);
    if (is_new) found->second.problem = load(name, found->second.cloud);
    return found->second;
}

const LoadedCloud* CloudLibrary::find(const std::string& name, SourceLocation at) {
    if (name.empty()) return nullptr;
    const std::lock_guard lock(mutex_);
    Entry& known = entry(name);
    if (!known.problem.empty() && !known.reported && diagnostics_)
        diagnostics_->error(at, fmt::format("point cloud \"{}\" cannot be read: {}", name, known.problem),
                            "point-cloud " + name);
    known.reported = true;
    return known.cloud.get();
}

const SurfelTree* CloudLibrary::surfels(const std::string& name, std::string* problem) {
    const std::lock_guard lock(mutex_);
    Entry& known = entry(name);
    if (known.cloud && !known.surfels && known.surfel_problem.empty()) {
        auto tree = std::make_unique<const SurfelTree>(surfels_of(known.cloud->cloud));
        if (tree->bytes() <= limit_ - bytes_)
            bytes_ += tree->bytes(), known.surfels = std::move(tree);
        else
            known.surfel_problem = too_large();
    }
    if (!known.surfels) *problem = known.cloud ? known.surfel_problem : known.problem;
    return known.surfels.get();
}

size_t CloudLibrary::bytes_left() {
    const std::lock_guard lock(mutex_);
    return limit_ - bytes_;
}

bool CloudLibrary::reserve(size_t bytes) {
    const std::lock_guard lock(mutex_);
    if (bytes > limit_ - bytes_) return false;
    bytes_ += bytes;
    return true;
}

}  // namespace trapeze
