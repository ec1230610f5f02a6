#include "shade/clouds/cloud_bakes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <tuple>

#include "core/files/output_file.h"
#include "shade/clouds/ply_file.h"
#include "shade/clouds/ptc_file.h"

namespace trapeze {
namespace {

using Place = std::tuple<uint32_t, uint32_t, uint32_t>;

Place place_of(const SourceLocation& at) {
    return {at.source, at.line, at.column};
}

bool names_ply(std::string name) {
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
    return name.ends_with(".ply");
}

void append(const BakedCall& call, PointCloud& cloud) {
    const size_t floats = cloud.floats_per_point(), stride = BakedCall::kPlain + floats;
    for (const float* p = call.points.data(); p < call.points.data() + call.points.size(); p += stride) {
        cloud.positions.emplace_back(p[0], p[1], p[2]);
        cloud.normals.emplace_back(p[3], p[4], p[5]);
        cloud.radii.push_back(p[6]);
        cloud.values.insert(cloud.values.end(), p + BakedCall::kPlain, p + stride);
    }
}

}  // namespace

size_t BakedCall::bytes() const {
    return sizeof *this + file.size() + channels.size() * sizeof(CloudChannel) +
           points.size() * sizeof(float);
}

bool CloudBakes::reserve(const BakedCall& call) {
    const size_t bytes = call.bytes();
    if (bytes_.fetch_add(bytes) + bytes <= limit_) return true;
    bytes_ -= bytes;
    const std::lock_guard lock(mutex_);
    refused_.try_emplace(call.file, call.at);
    return false;
}

void CloudBakes::add(std::vector<BakedGrid> grids) {
    const std::lock_guard lock(mutex_);
    for (BakedGrid& grid : grids) {
        if (grid.calls.empty()) continue;
        if (!grids_.insert(grid.ordinal).second) {
            for (const BakedCall& call : grid.calls) bytes_ -= call.bytes();
            continue;
        }
        for (size_t i = 0; i < grid.calls.size(); ++i) {
            BakedCall& call = grid.calls[i];
            std::string file = call.file;
            files_[std::move(file)].push_back({grid.ordinal, i, std::move(call)});
        }
    }
}

void CloudBakes::clear() {
    grids_.clear(), files_.clear(), refused_.clear();
    bytes_ = 0;
}

/// Says how many points were left out, once for each call of a shader.
void CloudBakes::report(const std::vector<Kept>& calls, Diagnostics& diagnostics) const {
    std::map<Place, std::pair<SourceLocation, size_t>> left_out;
    for (const Kept& kept : calls) {
        auto& [at, count] = left_out[place_of(kept.call.at)];
        at = kept.call.at, count += kept.call.not_finite;
    }
    for (const auto& [place, said] : left_out)
        if (said.second > 0)
            diagnostics.warning(said.first,
                                fmt::format("bake3d: {} points of \"{}\" are left out: they have numbers "
                                            "that are not finite",
                                            said.second, calls.front().call.file));
}

/// All points of a file whose calls are in order. The first call says which channels it has.
PointCloud CloudBakes::joined(std::vector<Kept>& calls, Diagnostics& diagnostics) {
    PointCloud cloud;
    cloud.channels = calls.front().call.channels;
    std::map<Place, SourceLocation> others;
    for (Kept& kept : calls) {
        if (kept.call.channels == cloud.channels)
            append(kept.call, cloud);
        else
            others.emplace(place_of(kept.call.at), kept.call.at);
        kept.call.points = {};
    }
    for (const auto& [place, at] : others)
        diagnostics.error(at, fmt::format("bake3d: \"{}\" has other channels from another call; these points "
                                          "are left out",
                                          calls.front().call.file));
    return cloud;
}

void CloudBakes::write_file(const std::string& name, std::vector<Kept>& calls, const CloudView& view,
                            const Access& access, Diagnostics& diagnostics) {
    const SourceLocation at = calls.front().call.at;
    const bool ascii = calls.front().call.ascii;
    const OutputPlace place = place_to_write(name, access, at, diagnostics);
    std::string problem = place.problem;
    if (problem.empty()) {
        OutputFile file(place.path);
        const CloudSink sink = [&](std::string_view bytes) { return file.write(bytes.data(), bytes.size()); };
        if (file.open()) {
            const PointCloud cloud = joined(calls, diagnostics);
            if (names_ply(name) ? write_ply(cloud, ascii, sink) : write_ptc(cloud, view, sink)) file.commit();
        }
        problem = file.error();
    }
    if (!problem.empty())
        diagnostics.error(at, fmt::format("bake3d: \"{}\" cannot be written: {}", place.name, problem));
}

/// Says of every file that it is not written.
void CloudBakes::report_refused(Diagnostics& diagnostics) {
    for (const auto& [name, calls] : files_) refused_.try_emplace(name, calls.front().call.at);
    for (const auto& [name, at] : refused_)
        diagnostics.error(at,
                          fmt::format("bake3d: \"{}\" is not written: points that are baked take more than "
                                      "the {} MiB that they may",
                                      name, limit_ >> 20));
}

void CloudBakes::write(const CloudView& view, const Access& access, Diagnostics& diagnostics) {
    if (!refused_.empty()) {
        report_refused(diagnostics);
        return clear();
    }
    for (auto& [name, calls] : files_) {
        std::ranges::sort(calls, [](const Kept& a, const Kept& b) {
            return std::tie(a.ordinal, a.number) < std::tie(b.ordinal, b.number);
        });
        const SourceLocation at = calls.front().call.at;
        report(calls, diagnostics);
        if (name.empty())
            diagnostics.error(at, "bake3d: the name of the file is empty; nothing is written");
        else
            write_file(name, calls, view, access, diagnostics);
    }
    clear();
}

void CloudBakes::leave_out(Diagnostics& diagnostics) {
    for (const auto& [name, calls] : files_)
        diagnostics.warning(calls.front().call.at,
                            fmt::format("bake3d: \"{}\" is not written, for it would have the points of a "
                                        "tile alone; a run without --tiles writes it",
                                        name),
                            "bake-in-tile " + name);
    clear();
}

}  // namespace trapeze
