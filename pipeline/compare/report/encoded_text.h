/// Texts and bytes as HTML can hold them.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace trapeze {

/// A text for HTML, also for values of attributes: & < > " ' as entities.
std::string escaped(std::string_view text);

/// RFC 4648, with padding.
std::string base64(std::span<const unsigned char> bytes);

/// JSON for a <script> element: '<' is written as an escape, so that no name in it can end the element.
std::string script_safe(std::string_view json);

}  // namespace trapeze
