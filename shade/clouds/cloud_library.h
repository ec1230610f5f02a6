/// The point clouds that a frame's shaders look into, each read once, when it is first asked for.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics.h"
#include "core/files/access.h"
#include "core/scene/scene.h"
#include "shade/clouds/cloud_tree.h"
#include "shade/clouds/point_cloud.h"
#include "shade/clouds/surfel_tree.h"

namespace trapeze {

/// Reads a file of either format, by what it begins with. Nothing, and why, where it is none.
std::optional<PointCloud> read_point_cloud(std::string_view bytes, std::string* problem);

/// A cloud that can be asked.
struct LoadedCloud {
    explicit LoadedCloud(PointCloud of) : cloud(std::move(of)), tree(cloud) {}
    LoadedCloud(const LoadedCloud&) = delete;
    LoadedCloud& operator=(const LoadedCloud&) = delete;

    PointCloud cloud;
    CloudTree tree;

    /// The channel of a name, and the first of its floats among a point's; null where there is none.
    const CloudChannel* find(std::string_view name, size_t* first) const;
    size_t bytes() const;
};

class CloudLibrary {
  public:
    /// Searched are the folders of Option "searchpath" "texture". diagnostics may be null; `access` must
    /// outlive this.
    CloudLibrary(const Options& options, Diagnostics* diagnostics, const Access& access);

    /// All clouds together may take so many bytes; further ones are not read.
    void set_limit(size_t bytes) { limit_ = bytes; }

    /// The cloud of a file; null for one that cannot be read, which is reported once, and for an empty name,
    /// which is not. Thread-safe; the cloud lives as long as this.
    const LoadedCloud* find(const std::string& name, SourceLocation at);

    /// The points of a file as discs; null, and why, where it cannot be read. Thread-safe; they live as long
    /// as this.
    const SurfelTree* surfels(const std::string& name, std::string* problem);

    /// What further clouds may take; and whether so much is there, which is then taken. Thread-safe.
    size_t bytes_left();
    bool reserve(size_t bytes);

  private:
    struct Entry {
        std::unique_ptr<const LoadedCloud> cloud;
        std::string problem;  ///< why there is none
        bool reported = false;
        std::unique_ptr<const SurfelTree> surfels;
        std::string surfel_problem;
    };
    Entry& entry(const std::string& name);
    std::string load(const std::string& name, std::unique_ptr<const LoadedCloud>& cloud);
    std::string too_large() const;

    std::vector<std::string> folders_;
    Diagnostics* diagnostics_;
    const Access& access_;
    size_t limit_ = size_t{1} << 31, bytes_ = 0;
    std::mutex mutex_;
    std::map<std::string, Entry, std::less<>> clouds_;
};

}  // namespace trapeze
