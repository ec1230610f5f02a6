/// The border of every call: no exception leaves it, and what is wrong goes to the error handler.
#pragma once

#include <new>
#include <optional>
#include <stdexcept>

#include "pipeline/ri/context.h"

namespace trapeze::ri {

/// Runs `work`, and reports what it throws as of `name`. The handler is called when nothing is in flight any
/// more: it may jump, throw or exit.
template <class Work>
void guarded(const char* name, const Work& work) {
    std::optional<Message> wrong;
    const auto failed = [&](RtInt code, RtInt severity, const std::string& text) {
        wrong = Message{code, severity, std::string(name) + ": " + text};
    };
    try {
        work();
    } catch (const CallError& error) {
        failed(error.code, RIE_ERROR, error.text + "; the call is left out");
    } catch (const std::bad_alloc&) {
        failed(RIE_NOMEM, RIE_SEVERE, "out of memory");
    } catch (const std::exception& error) {
        failed(RIE_BUG, RIE_SEVERE, error.what());
    }
    if (wrong) report(std::move(*wrong));
}

/// Runs a call of the current context; without one the call is reported and left out. Afterwards the handler
/// gets what the call has complained of.
template <class Work>
void call(const char* name, const Work& work) {
    Context* const context = current_context();
    if (!context) {
        report({RIE_NOTSTARTED, RIE_ERROR, std::string(name) + ": RiBegin has not been called"});
        return;
    }
    guarded(name, [&] { work(*context); });
    for (const Message& message : context->take_messages())
        report({message.code, message.severity, std::string(name) + ": " + message.text});
}

/// Writes a call whose request has only numbers.
void write_numbers(const char* request, std::initializer_list<float> numbers);
/// Writes a call that sets an option by numbers: RIE_NOTOPTIONS within a world.
void write_option(const char* request, std::initializer_list<float> numbers);

}  // namespace trapeze::ri
