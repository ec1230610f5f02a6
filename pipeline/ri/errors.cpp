#include "pipeline/ri/errors.h"

#include <cstdio>
#include <cstdlib>

// RISpec's interface has no argument that could carry these: they are the process's (and so is the current
// context).
RtInt RiLastError = RIE_NOERROR;

namespace trapeze::ri {
namespace {

RtErrorHandler& current_handler() {
    static RtErrorHandler handler = RiErrorPrint;
    return handler;
}

const char* word_for(RtInt severity) {
    switch (severity) {
        case RIE_INFO:
            return "note";
        case RIE_WARNING:
            return "warning";
        case RIE_ERROR:
            return "error";
        default:
            return "severe error";
    }
}

}  // namespace

void set_error_handler(RtErrorHandler handler) {
    current_handler() = handler ? handler : RiErrorPrint;
}

void report(const Message& message) {
    if (message.severity >= RIE_ERROR) RiLastError = message.code;
    std::string text = message.text;  // the handler's argument is not const
    current_handler()(message.code, message.severity, text.data());
}

}  // namespace trapeze::ri

RtVoid RiErrorIgnore(RtInt, RtInt, char*) {}

RtVoid RiErrorPrint(RtInt code, RtInt severity, char* message) {
    std::fprintf(stderr, "%s %d: %s\n", trapeze::ri::word_for(severity), code, message ? message : "");
}

RtVoid RiErrorAbort(RtInt code, RtInt severity, char* message) {
    RiErrorPrint(code, severity, message);
    if (severity >= RIE_ERROR) std::exit(1);
}
