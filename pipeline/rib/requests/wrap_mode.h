/// How meshes and curves close.
#pragma once

#include "pipeline/rib/reader/request_report.h"

namespace trapeze::rib {

/// Whether the next word is "periodic". Others than RISpec's two leave the shape open: it is drawn all the
/// same. Periodic: the last point is followed by the first.
inline bool takes_periodic(RequestReport& report, ArgumentCursor& c) {
    const std::string wrap = c.string("the wrap mode");
    if (wrap != "periodic" && wrap != "nonperiodic")
        report.warn_once(in_quotes(wrap) + " is neither periodic nor nonperiodic; taken as nonperiodic",
                         "wrap-mode");
    return wrap == "periodic";
}

}  // namespace trapeze::rib
