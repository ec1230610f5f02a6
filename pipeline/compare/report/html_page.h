/// The frame of every report: one HTML file that loads nothing from anywhere, light and dark.
#pragma once

#include <string>

#include "pipeline/compare/machine.h"

namespace trapeze {

/// The page up to the open <body>, with the style sheet.
std::string html_head(const std::string& title);

/// A figure with its name below it; a line of these heads a report.
std::string html_fact(const std::string& value, const std::string& name);

/// An entry of a description list.
std::string html_entry(const std::string& name, const std::string& value);

/// The entries that describe the machine.
std::string html_machine(const Machine& machine);

}  // namespace trapeze
