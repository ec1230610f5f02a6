#include "pipeline/ri/errors.h"

#include <array>
#include <cstdio>
#include <cstdlib>

// RISpec's interface has no argument that could carry these: they belong to the process, as the current
// context does.
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

void report(Message message) {
    if (message.severity >= RIE_ERROR) RiLastError = message.code;
    // A handler that jumps away leaves nothing to be freed; one that calls the interface again, and is called
    // for that, has the next text.
    static thread_local std::array<std::string, 8> texts;
    static thread_local size_t count = 0;
    std::string& text = texts[count++ % texts.size()];
    text = std::move(message.text);
    message.text = {};
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
