#include "pipeline/rib/requests/colorspaces.h"

namespace trapeze::rib {

bool names_transfer(Reader& reader, const Parameter& value) {
    const std::string name = value.strings.empty() ? "" : value.strings[0];
    if (transfer_named(name)) return true;
    reader.error(in_quotes(value.name) + " is " + kTransferNames + ", not " + in_quotes(name));
    return false;
}

std::optional<Transfer> colorspace_of(Reader& reader, ParameterList& parameters) {
    const Parameter* value = parameters.find("colorspace");
    if (!value) return {};
    if (names_transfer(reader, *value)) return transfer_named(value->strings[0]);
    std::erase_if(parameters.values, [](const Parameter& p) { return p.name == "colorspace"; });
    return {};
}

}  // namespace trapeze::rib
