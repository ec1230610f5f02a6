/// What every report is: one HTML file that loads nothing from anywhere, light and dark.
#pragma once

#include <string>

#include "pipeline/compare/machine.h"

namespace trapeze {

/// To the open body.
std::string html_head(const std::string& title);

/// A value with its name below it, of a line of such.
std::string html_fact(const std::string& value, const std::string& name);

/// An entry of a description list.
std::string html_entry(const std::string& name, const std::string& value);

/// The machine's entries.
std::string html_machine(const Machine& machine);

}  // namespace trapeze
