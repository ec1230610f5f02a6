/// How numbers of files stand for light: Option "color" "transfer", and what overrides it for one file. It is
/// about whole numbers, of 8 and 16 bits; floats are light as they are.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/scene/scene.h"

namespace trapeze {

/// Linear: numbers are proportional to light, as RISpec has it. Srgb: colours are encoded by the sRGB curve.
/// Auto: they are in 8 bits, unless Exposure has a gamma or a file to read says otherwise; 16 bits are
/// linear.
enum class Transfer : uint8_t { Linear, Srgb, Auto };

/// The transfer of a name, "linear", "srgb" or "auto" in letters of any case; nothing for another name.
std::optional<Transfer> transfer_named(std::string_view name);

/// What is said of a name that is none of them.
inline constexpr const char* kTransferNames = "\"linear\", \"srgb\" or \"auto\"";

/// The scene's Option "color" "transfer"; Linear where it is not set.
Transfer transfer_of(const Options& options);

/// Sets Option "color" "transfer" for the whole scene, as --transfer does.
void set_transfer(Options& options, std::string_view name);

}  // namespace trapeze
