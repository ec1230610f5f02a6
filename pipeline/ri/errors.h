/// What is wrong with a call of the RenderMan Interface: a code of RISpec's (ri.h), a severity and words.
#pragma once

#include <string>
#include <utility>

#include "pipeline/ri/ri.h"

namespace trapeze::ri {

/// Thrown within a call, caught at its border: nothing of the call is written.
struct CallError {
    RtInt code;
    std::string text;
};

/// What the error handler is called with.
struct Message {
    RtInt code, severity;  ///< RIE_... code; RIE_INFO to RIE_SEVERE
    std::string text;
};

/// Sets what report() calls, for the whole process; null: RiErrorPrint.
void set_error_handler(RtErrorHandler handler);

/// Sets RiLastError, except for messages that are no errors, and calls the handler, which may not return. No
/// exception may be in flight.
void report(Message message);

/// The pointer; throws RIE_MISSINGDATA for null, which messages call `what`.
template <class T>
T* required(T* pointer, const char* what) {
    if (!pointer) throw CallError{RIE_MISSINGDATA, std::string(what) + " is null"};
    return pointer;
}

}  // namespace trapeze::ri
