/// Requests are rows of tables, one table for each group, each in its own file.
#pragma once

#include <span>

#include "pipeline/rib/reader/known_requests.h"
#include "pipeline/rib/reader/request_context.h"

namespace trapeze::rib {

/// A request's name as RIB writes it, and its handler. Rows stay as plain data in the program; the table is
/// made of them when it is first asked for.
struct RequestRow {
    const char* name;
    RequestHandler handler;
};

/// The options, for a request that sets some: a warning in a world, a RequestError in archives that it reads.
Options& changeable_options(OptionContext& context);

/// The attributes that primitives keep, for a request that sets `what`.
inline Attributes& changeable_attributes(StateContext& context, Own what) {
    return context.state.change_attributes(what).attributes;
}

/// One table for each file of handlers; request_table.cpp puts them together. A new request is a handler and
/// a row in the file of its family (and a row in ri.h, if C programs shall call it).
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
