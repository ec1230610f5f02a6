#include "core/colors/transfer.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace trapeze {

std::optional<Transfer> transfer_named(std::string_view name) {
    std::string lower(name);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    if (lower == "linear") return Transfer::Linear;
    if (lower == "srgb") return Transfer::Srgb;
    if (lower == "auto") return Transfer::Auto;
    return {};
}

Transfer transfer_of(const Options& options) {
    return transfer_named(options.user.string_or("color", "transfer", "")).value_or(Transfer::Linear);
}

void set_transfer(Options& options, std::string_view name) {
    Parameter value;
    value.name = "transfer";
    value.declaration = {StorageClass::Uniform, ValueType::String, 1};
    value.strings = {std::string(name)};
    options.user.set("color", std::move(value));
}

}  // namespace trapeze
