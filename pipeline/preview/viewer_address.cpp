#include "pipeline/preview/viewer_address.h"

#include <charconv>

namespace trapeze {
namespace {

constexpr std::string_view kTevHost = "127.0.0.1";
constexpr int kTevPort = 14158;
constexpr int kMostPort = 65535;

std::optional<int> parse_port(std::string_view text) {
    int port = 0;
    const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), port);
    if (wrong != std::errc{} || end != text.data() + text.size() || port < 1 || port > kMostPort) return {};
    return port;
}

/// The text behind "name" or "name:"; nothing where it is not of this name.
std::optional<std::string_view> rest_of(std::string_view text, std::string_view name) {
    if (!text.starts_with(name)) return {};
    text.remove_prefix(name.size());
    if (text.empty()) return text;
    if (text.front() != ':' || text.size() == 1) return {};
    return text.substr(1);
}

std::optional<ViewerAddress> parse_tev(std::string_view rest) {
    ViewerAddress tev{ViewerAddress::Kind::Tev, std::string(kTevHost), kTevPort};
    if (rest.empty()) return tev;
    const size_t colon = rest.rfind(':');
    const auto port = parse_port(colon == rest.npos ? rest : rest.substr(colon + 1));
    if (!port) return {};
    tev.port = *port;
    if (colon == rest.npos) return tev;
    std::string_view host = rest.substr(0, colon);
    if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
    if (host.empty()) return {};
    tev.host = host;
    return tev;
}

}  // namespace

std::optional<ViewerAddress> parse_viewer(std::string_view text) {
    if (const auto rest = rest_of(text, "tev")) return parse_tev(*rest);
    const auto rest = rest_of(text, "web");
    if (!rest) return {};
    if (rest->empty()) return ViewerAddress{};
    const auto port = parse_port(*rest);
    if (!port) return {};
    return ViewerAddress{ViewerAddress::Kind::Web, {}, *port};
}

}  // namespace trapeze
