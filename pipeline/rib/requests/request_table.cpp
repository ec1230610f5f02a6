#include "pipeline/rib/requests/request_table.h"

#include <algorithm>
#include <map>
#include <string_view>

namespace trapeze::rib {
namespace {

/// The rest of RISpec 3.2, and what later RenderMans added: skipped whole.
constexpr const char* kUnsupported[] = {"Deformation",  "Volume",        "MakeOcclusion",
                                        "MakeBrickMap", "MakeTexture3D", "VPInterior",
                                        "VPAtmosphere", "VPSurface",     "Shader"};

/// A map by name that can be asked with a piece of the text, without a copy.
using Table = std::map<std::string, Request, std::less<>>;

/// Made once, from the groups' tables: a group says what motion blocks do with its requests.
const Table& table() {
    static const Table all = [] {
        Table rows;
        const auto add = [&](std::span<const RequestRow> requests, RequestGroup group) {
            for (const RequestRow& row : requests) rows[row.name] = {row.handler, group};
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
        return rows;
    }();
    return all;
}

/// Levenshtein's distance; letters that differ in case are equal.
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
    return table().contains(name);
}

const Request* find_request(std::string_view name) {
    const auto row = table().find(name);
    return row == table().end() ? nullptr : &row->second;
}

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
