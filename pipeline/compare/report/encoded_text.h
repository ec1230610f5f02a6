/// Texts and bytes as HTML can hold them.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace trapeze {

/// & < > " ' as entities: for text and for values of attributes.
std::string escaped(std::string_view text);

std::string base64(std::span<const unsigned char> bytes);

/// JSON that may stand in a <script>: no '<', so that no name in it can end the element.
std::string script_safe(std::string_view json);

}  // namespace trapeze
