/// Carries out a file's requests to make maps.
#pragma once

#include "core/diagnostics.h"
#include "core/files/access.h"
#include "pipeline/rib/map_request.h"

namespace trapeze {

/// Makes the map of a request. Pictures are looked for where their names say, which is where displays are
/// written, then in the request's folders; the map is written where its name says. What goes wrong is
/// reported as an error, and nothing is written; `written` is empty then, else the map's file. False when it
/// was the map's file that could not be written.
bool make_map(const MapRequest& request, const Access& access, Diagnostics& diagnostics,
              std::string* written = nullptr);

/// Names of the request's pictures that are in none of these places.
std::vector<std::string> missing_pictures(const MapRequest& request, const Access& access);

}  // namespace trapeze
