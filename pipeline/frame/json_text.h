#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace trapeze {

/// A JSON value as text. File names may be of any bytes; bytes that are no UTF-8 become U+FFFD. An indent of
/// -1 makes one line.
inline std::string json_text(const nlohmann::ordered_json& value, int indent = 2) {
    return value.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace trapeze
