/// COMPLIANCE.md: where the program stands against the RenderMan Interface 3.2, made from its own tables.
#pragma once

#include <string>
#include <vector>

namespace trapeze {

/// Markdown. `scenes` are RIB files (each showing something); a request is shown by the one that fits it
/// best.
std::string compliance_page(const std::vector<std::string>& scenes);

/// What the page says of requests, for tests: names with notes that no table of the program knows.
std::vector<std::string> notes_without_request();

}  // namespace trapeze
