/// Where programs of procedurals are found.
#pragma once

#include <string>
#include <vector>

namespace trapeze::rib {

/// The program of this name in one of the folders, else the name: as it is, or to be looked for along PATH.
std::string program_path(const std::string& name, const std::vector<std::string>& folders);

/// Whether there is such a program, in the folders or along PATH.
bool has_program(const std::string& name, const std::vector<std::string>& folders);

}  // namespace trapeze::rib
