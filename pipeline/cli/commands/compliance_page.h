/// COMPLIANCE.md: where the program stands against the RenderMan Interface 3.2, made from its own tables.
#pragma once

#include <string>
#include <vector>

namespace trapeze {

/// The page in Markdown. `scenes` are RIB files, each showing something; a request is illustrated by the
/// scene that fits it best.
std::string compliance_page(const std::vector<std::string>& scenes);

/// Names with notes that no table of the program knows: there should be none, which a test checks.
std::vector<std::string> notes_without_request();

}  // namespace trapeze
