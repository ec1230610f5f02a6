#pragma once

namespace trapeze {

/// The program's exit codes; the table in --help is made from these meanings.
enum ExitCode : int {
    kExitOk = 0,
    kExitErrors = 1,  ///< rendered with errors, or with warnings under --strict
    kExitUsage = 2,
    kExitNoInput = 3,          ///< an input file is missing or unreadable
    kExitNothingRendered = 4,  ///< nothing went wrong, but no picture was made
    kExitShaderMissing = 5,    ///< under --strict
    kExitNoOutput = 6,         ///< an output cannot be written
    kExitNoMemory = 7,         ///< out of memory, or a picture that the machine cannot hold
    kExitTimeLimit = 8,        ///< of --time-limit
    kExitInternal = 70,        ///< an exception that nobody expected
    kExitInterrupted = 130,    ///< by SIGINT: 128 + 2
    kExitTerminated = 143,     ///< by SIGTERM: 128 + 15
};

inline constexpr const char* kExitCodeHelp =
    "Exit codes: 0 ok; 1 done with errors (or warnings under --strict); 2 usage; 3 input not readable;\n"
    "4 nothing rendered; 5 a shader is missing (under --strict); 6 output not writable;\n"
    "7 out of memory; 8 the time limit was reached; 70 internal error; 130 interrupted; 143 terminated.";

}  // namespace trapeze
