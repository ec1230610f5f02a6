/// Which instruction sets the vector code may use [decision 0022]. Highway keeps this choice for the whole
/// process, and so this is the one thing that is not passed in a context [decision 0021]: it is set once, at
/// the start of a program, before any other work. No result depends on it, only time.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trapeze {

/// "best" and the instruction sets that limit_simd() knows on this kind of machine, narrowest first.
std::vector<std::string_view> simd_names();

/// Those of simd_names() that this build has vector code for, without "best": a build for the machine that
/// makes it has one alone (cmake/InstructionSets.cmake).
std::vector<std::string_view> compiled_simd_names();

/// The instruction set without which this build does not run, where the machine lacks it; else empty. A build
/// of all sets has plain code, too, and runs everywhere.
std::string_view lacking_simd();

/// Vector code uses nothing better than the named instruction set from now on. False with *error set, and
/// nothing changed, when there is no such name, or the machine or this build lacks it. Not while other
/// threads work.
bool limit_simd(std::string_view name, std::string* error);

/// The best instruction set that vector code may use now, as limit_simd() names it; "best" where it has no
/// name for it.
std::string_view simd_limit();

}  // namespace trapeze
