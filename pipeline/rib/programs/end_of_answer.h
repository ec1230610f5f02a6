/// Where the answer of a RunProgram ends: at a byte 0377 (RISpec 5.8) that is part of no string, comment or
/// encoded value. Programs whose output is text write it as that character in UTF-8, the bytes 0303 0277, the
/// first of which RISpec reserves.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace trapeze::rib {

/// Looks through bytes as they arrive.
class EndOfAnswer {
  public:
    /// `bytes` are all that have arrived. The place of the end, once it is there.
    std::optional<size_t> find(std::string_view bytes);

  private:
    /// What the next byte is part of. Encoded values are no state of their own: they are taken when whole.
    enum class Within { Text, String, Comment };

    size_t next_ = 0;  ///< the first byte not looked at
    Within within_ = Within::Text;
};

}  // namespace trapeze::rib
