#include "pipeline/rib/requests/request_table.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

namespace trapeze::rib {
namespace {

/// The rest of RISpec 3.2, and what later RenderMans added: skipped whole.
constexpr const char* kUnsupported[] = {"Deformation",  "Volume",        "MakeOcclusion",
                                        "MakeBrickMap", "MakeTexture3D", "VPInterior",
                                        "VPAtmosphere", "VPSurface",     "Shader"};

using Table = std::map<std::string, Request>;

/// Made once, from the groups' tables: a group says what motion blocks do with its requests.
const Table& table() {
    static const Table all = [] {
        Table rows;
        const auto add = [&](std::span<const RequestRow> requests, RequestGroup group) {
            for (const RequestRow& row : requests) rows[row.name] = {row.handler, group, {}, 0};
        };
        add(structure_requests(), RequestGroup::Structure);
        add(conditional_requests(), RequestGroup::Structure);
        add(state_requests(), RequestGroup::Structure);
        add(detail_requests(), RequestGroup::Attribute);
        add(procedural_requests(), RequestGroup::Structure);
        add(ris_requests(), RequestGroup::Structure);
        add(option_requests(), RequestGroup::Option);
        add(display_requests(), RequestGroup::Option);
        add(attribute_requests(), RequestGroup::Attribute);
        add(shader_requests(), RequestGroup::Attribute);
        add(solid_requests(), RequestGroup::Structure);
        add(transform_requests(), RequestGroup::Transform);
        add(polygon_requests(), RequestGroup::Geometry);
        add(curved_surface_requests(), RequestGroup::Geometry);
        add(curve_requests(), RequestGroup::Geometry);
        add(trim_requests(), RequestGroup::Attribute);
        add(nu_patch_requests(), RequestGroup::Geometry);
        add(blobby_requests(), RequestGroup::Geometry);
        add(geometry_requests(), RequestGroup::Geometry);
        add(map_requests(), RequestGroup::Option);
        for (const char* name : kUnsupported) rows.try_emplace(name);
        for (size_t number = 0; auto& [name, request] : rows) request.name = name, request.number = number++;
        return rows;
    }();
    return all;
}

/// The table by a hash of the names, as a scene asks for millions of requests by name.
class RequestIndex {
  public:
    RequestIndex() {
        for (const auto& [name, request] : table()) {
            size_t slot = slot_of(name);
            while (slots_[slot]) slot = (slot + 1) % kSlots;
            slots_[slot] = &request;
        }
    }
    const Request* find(std::string_view name) const {
        if (name.empty()) return nullptr;
        for (size_t slot = slot_of(name); slots_[slot]; slot = (slot + 1) % kSlots)
            if (slots_[slot]->name == name) return slots_[slot];
        return nullptr;
    }

  private:
    static constexpr size_t kSlots = 1024;  ///< some eight times as many as there are requests

    /// Of four letters and the length, which tell nearly all names apart.
    static size_t slot_of(std::string_view name) {
        const auto letter = [&](size_t i) { return static_cast<unsigned char>(name[i]); };
        const size_t n = name.size();
        return (n * 37 + letter(0) * 131u + letter(n / 2) * 17u + letter(n - 1) * 59u +
                letter(n - 1 - n / 4) * 251u) %
               kSlots;
    }
    std::array<const Request*, kSlots> slots_{};
};

/// Made when the first request is looked up, by whichever thread does: initialisation of such a static is
/// safe among threads.
const RequestIndex& request_index() {
    static const RequestIndex index;
    return index;
}

/// Levenshtein's distance; letters that differ in case are equal. One row of the usual table is kept: each
/// entry needs the one above, the one to the left and their corner.
int distance(std::string_view a, std::string_view b) {
    std::vector<int> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
    for (size_t i = 1; i <= a.size(); ++i) {
        int diagonal = row[0];
        row[0] = static_cast<int>(i);
        for (size_t j = 1; j <= b.size(); ++j) {
            const int keep = diagonal + ((a[i - 1] | 0x20) == (b[j - 1] | 0x20) ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({keep, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row[b.size()];
}

}  // namespace

bool is_request(std::string_view name) {
    return request_index().find(name);
}

const Request* find_request(std::string_view name) {
    return request_index().find(name);
}

/// Sorted, as the map is; a request's number is its place in this list (Request::number).
std::vector<std::string> request_names() {
    std::vector<std::string> names;
    for (const auto& [name, request] : table()) names.push_back(name);
    return names;
}

/// Up to a quarter of the letters may be wrong, and one more.
std::string suggestion_for(const std::string& name) {
    if (name.size() > 40) return {};
    std::string best;
    int best_distance = 1 + static_cast<int>(name.size()) / 4;
    for (const auto& [known, request] : table())
        if (const int d = distance(name, known); d < best_distance + (best.empty() ? 1 : 0))
            best = known, best_distance = d;
    return best;
}

}  // namespace trapeze::rib
