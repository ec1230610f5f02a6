/// Transfers are named as core/colors/transfer.h lists them; "" is none of them.
#include "pipeline/rib/requests/colorspaces.h"

#include "pipeline/rib/syntax/arguments.h"

namespace trapeze::rib {

bool names_transfer(RequestReport& report, const Parameter& value) {
    const std::string name = value.strings.empty() ? "" : value.strings[0];
    if (transfer_named(name)) return true;
    report.error(in_quotes(value.name) + " is " + kTransferNames + ", not " + in_quotes(name));
    return false;
}

/// A wrong value is taken out of the list, so that later stages do not report it again.
std::optional<Transfer> colorspace_of(RequestReport& report, ParameterList& parameters) {
    const Parameter* value = parameters.find("colorspace");
    if (!value) return {};
    if (names_transfer(report, *value)) return transfer_named(value->strings[0]);
    std::erase_if(parameters.values, [](const Parameter& p) { return p.name == "colorspace"; });
    return {};
}

}  // namespace trapeze::rib
