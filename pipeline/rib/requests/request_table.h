/// Requests are rows of tables, one table for each group, each in its own file.
#pragma once

#include <span>

#include "pipeline/rib/reader/known_requests.h"
#include "pipeline/rib/reader/request_context.h"

namespace trapeze::rib {

struct RequestRow {
    const char* name;
    RequestHandler handler;
};

std::span<const RequestRow> structure_requests();
std::span<const RequestRow> conditional_requests();
std::span<const RequestRow> state_requests();
std::span<const RequestRow> detail_requests();
std::span<const RequestRow> procedural_requests();
std::span<const RequestRow> ris_requests();
std::span<const RequestRow> option_requests();
std::span<const RequestRow> display_requests();
std::span<const RequestRow> attribute_requests();
std::span<const RequestRow> shader_requests();
std::span<const RequestRow> solid_requests();
/// For requests that belong before the world: a warning in one, an error in archives that it reads.
Options& changeable_options(RequestContext& context);
std::span<const RequestRow> transform_requests();
std::span<const RequestRow> polygon_requests();
std::span<const RequestRow> curved_surface_requests();
std::span<const RequestRow> curve_requests();
std::span<const RequestRow> nu_patch_requests();
std::span<const RequestRow> trim_requests();
std::span<const RequestRow> blobby_requests();
std::span<const RequestRow> geometry_requests();
std::span<const RequestRow> map_requests();

}  // namespace trapeze::rib
