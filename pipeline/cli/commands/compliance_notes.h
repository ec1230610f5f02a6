/// What the compliance page says of requests and capabilities beyond what the program's tables know.
#pragma once

#include <span>

namespace trapeze {

/// A limit of a request that is carried out.
struct RequestNote {
    const char* request;
    const char* limits;
};
std::span<const RequestNote> request_notes();

/// One of RISpec's optional capabilities (section 1.1).
struct Capability {
    const char* name;
    const char* standing;  ///< supported, supported with limits, not supported
    const char* text;
};
std::span<const Capability> capabilities();

/// Requests that RISpec 3.2 defines; others in the program's table came later.
std::span<const char* const> rispec_requests();

/// Built-in functions that compile, with what limits them.
std::span<const RequestNote> function_notes();

/// A header for shaders that the program carries: the functions and macros in it, and what others' of this
/// name have beyond that.
struct HeaderNote {
    const char* name;
    const char* has;
    const char* lacks;
};
std::span<const HeaderNote> header_notes();

}  // namespace trapeze
