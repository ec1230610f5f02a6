/// The points that a frame's shaders bake, until the frame is done and they are written.
///
/// A file's points stand in the order of the grids' ordinals, then of the calls as a grid makes them, then of
/// the vertices: it is the same for any number of threads and any split into regions. A grid that is shaded
/// again, for another region, bakes once.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <unordered_set>
#include <vector>

#include "core/diagnostics.h"
#include "core/files/access.h"
#include "shade/clouds/cloud_view.h"
#include "shade/clouds/point_cloud.h"

namespace trapeze {

/// What one call baked of one grid.
struct BakedCall {
    std::string file;
    std::vector<CloudChannel> channels;
    bool ascii = false;  ///< of PLY
    SourceLocation at;   ///< of the call
    std::vector<float>
        points;             ///< kPlain floats (position, normal, radius) and the channels', point by point
    size_t not_finite = 0;  ///< points that were left out for it

    static constexpr size_t kPlain = 7;
    size_t bytes() const;
};

/// What the calls of one run baked of one grid, in their order.
struct BakedGrid {
    uint64_t ordinal = 0;
    std::vector<BakedCall> calls;
};

class CloudBakes {
  public:
    /// All points together may take so many bytes; where they take more, nothing is written.
    void set_limit(size_t bytes) { limit_ = bytes; }

    /// Asks whether a call's points may be kept until they are added; where not they are to be forgotten, and
    /// nothing will be written. Thread-safe.
    bool reserve(const BakedCall& call);

    /// Keeps what grids baked that have not been here before, and gives back what was reserved for others.
    /// Thread-safe.
    void add(std::vector<BakedGrid> grids);

    /// Forgets all: shading begins anew.
    void clear();

    /// Writes all files, each of which appears whole or not at all, and says what was wrong.
    void write(const CloudView& view, const Access& access, Diagnostics& diagnostics);
    /// Forgets all, and warns of each file that it is not written: what was shaded is a tile of the picture.
    void leave_out(Diagnostics& diagnostics);

  private:
    struct Kept {
        uint64_t ordinal;
        size_t number;  ///< among the calls of the grid
        BakedCall call;
    };
    void report_refused(Diagnostics& diagnostics);
    void report(const std::vector<Kept>& calls, Diagnostics& diagnostics) const;
    static PointCloud joined(std::vector<Kept>& calls, Diagnostics& diagnostics);
    static void write_file(const std::string& name, std::vector<Kept>& calls, const CloudView& view,
                           const Access& access, Diagnostics& diagnostics);

    std::mutex mutex_;
    std::unordered_set<uint64_t> grids_;
    std::map<std::string, std::vector<Kept>> files_;  ///< by name
    size_t limit_ = size_t{1} << 31;
    std::atomic<size_t> bytes_{0};                   ///< that are reserved
    std::map<std::string, SourceLocation> refused_;  ///< files for whose points there was no room
};

}  // namespace trapeze
