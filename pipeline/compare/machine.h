/// Where figures were measured.
#pragma once

#include <string>

namespace trapeze {

struct Machine {
    std::string cpu;       ///< model, as the operating system names it
    std::string simd;      ///< instruction set that the vector code runs on
    std::string system;    ///< operating system and its release
    std::string compiler;  ///< that built the program
    std::string trapeze;   ///< version
    std::string revision;  ///< of the source that was built
    int threads = 1;       ///< that the work ran on
};

/// Describes the machine and this program, but for `trapeze` and `revision`; the threads are the calling task
/// arena's.
Machine this_machine();

}  // namespace trapeze
