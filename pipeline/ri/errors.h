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

struct Message {
    RtInt code, severity;
    std::string text;
};

/// Null: RiErrorPrint.
void set_error_handler(RtErrorHandler handler);

/// Sets RiLastError, but for what is no error, and calls the handler, which may not return. No exception may
/// be in flight.
void report(Message message);

/// Throws RIE_MISSINGDATA for null.
template <class T>
T* required(T* pointer, const char* what) {
    if (!pointer) throw CallError{RIE_MISSINGDATA, std::string(what) + " is null"};
    return pointer;
}

}  // namespace trapeze::ri
