/// Reports and figures that commands write beside their work: whole or not at all.
#pragma once

#include <initializer_list>
#include <string>

#include "core/diagnostics.h"
#include "core/files/access.h"
#include "pipeline/cli/support/terminal.h"

namespace trapeze {

/// Whether files can be made at these paths; reports where not. Asked first, before minutes are spent on what
/// cannot be written. Empty names are left out.
bool can_write(std::initializer_list<std::string> paths, Diagnostics& diagnostics);

/// Makes a folder, and those above it, where it is not there; reports why not.
bool make_folder(const std::string& path, Diagnostics& diagnostics);

/// Whether a report of the run may be written at a path. Confined runs (--safe) write only below the working
/// folder; other runs write over a file outside of the working folder only if it is such a report. Reports
/// why not, and that the path lies outside.
bool may_write_report(const std::string& path, const Access& access, Diagnostics& diagnostics);

/// Writes a text file whole, or not at all; reports why not, and names the file on a terminal.
bool write_text(const std::string& path, const std::string& text, Terminal& terminal,
                Diagnostics& diagnostics);

}  // namespace trapeze
