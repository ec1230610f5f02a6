/// Which viewer a run is shown by, as `--preview` names it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace trapeze {

struct ViewerAddress {
    enum class Kind { Tev, Web };
    Kind kind = Kind::Web;
    std::string host;  ///< of tev
    int port = 0;      ///< 0, of Web: the first of the usual ones that is free
};

/// "tev", "tev:PORT", "tev:HOST:PORT", "web" or "web:PORT"; tev is at 127.0.0.1:14158 where nothing else is
/// said. A host may be an IPv6 address in brackets. Nothing for any other text; ports are 1 to 65535.
std::optional<ViewerAddress> parse_viewer(std::string_view text);

}  // namespace trapeze
