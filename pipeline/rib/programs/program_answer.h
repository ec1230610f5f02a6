/// One request to a program that runs, and what it answers (RISpec 5.8).
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>

namespace trapeze::rib {

/// The text ends where the program, a limit or the caller ended it.
struct ProgramAnswer {
    std::string text;     ///< as far as it came
    std::string problem;  ///< empty when it is whole
};

/// When to give up on a program. Silence is measured from its last byte, not from the request: a long answer
/// may take as long as it likes, as long as something of it comes.
struct AnswerLimits {
    std::chrono::milliseconds silence{10000};  ///< a program that says nothing for so long does not answer
    size_t most_bytes = size_t{1} << 30;
    /// Called each second that it says nothing, with how many there have been. May be empty.
    std::function<void(int)> on_wait;
    const std::atomic<bool>* cancelled = nullptr;
};

/// Writes the request to `input`, a socket, and reads the answer from `output` meanwhile, each without
/// waiting for the other. What arrives together with the end of the answer but behind it is dropped.
ProgramAnswer ask_program(int input, int output, const std::string& request, const AnswerLimits& limits);

}  // namespace trapeze::rib
