/// Reports and figures that commands write beside their work: whole or not at all.
#pragma once

#include <initializer_list>
#include <string>

#include "core/diagnostics.h"
#include "core/files/access.h"

namespace trapeze {

/// Whether files can be made there; says where not. Before minutes are spent on what cannot be written. Empty
/// names are left out.
bool can_write(std::initializer_list<std::string> paths, Diagnostics& diagnostics);

/// Whether a report of the run may be written there: confined (--safe), below the working folder alone; else
/// what is there outside of the working folder is only written over if it is such a report. Says why not, and
/// that it lies outside.
bool may_write_report(const std::string& path, const Access& access, Diagnostics& diagnostics);

/// Says why not.
bool write_text(const std::string& path, const std::string& text, Diagnostics& diagnostics);

}  // namespace trapeze
