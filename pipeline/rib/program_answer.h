/// One request to a program that runs, and what it answers (RISpec 5.8).
#pragma once

#include <chrono>
#include <string>

namespace trapeze::rib {

struct ProgramAnswer {
    std::string text;     ///< as far as it came
    std::string problem;  ///< empty when it is whole
};

/// Writes the request to `input`, a socket, and reads the answer from `output` meanwhile, each without
/// waiting for the other. What arrives together with the end of the answer but behind it is dropped.
ProgramAnswer ask_program(int input, int output, const std::string& request,
                          std::chrono::milliseconds time_limit, size_t most_bytes);

}  // namespace trapeze::rib
