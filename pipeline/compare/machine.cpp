#include "pipeline/compare/machine.h"

#include <sys/utsname.h>
#include <tbb/task_arena.h>

#include <fstream>

#include "sample/visibility.h"

namespace trapeze {
namespace {

/// The value after "key ... :" in a file of such lines, as /proc/cpuinfo.
std::string value_in(const char* file, const std::string& key) {
    std::ifstream lines(file);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with(key)) {
            const size_t colon = line.find(':');
            const size_t begin = line.find_first_not_of(" \t", colon + 1);
            if (colon != std::string::npos && begin != std::string::npos) return line.substr(begin);
        }
    return {};
}

std::string system_name() {
    utsname name{};
    if (uname(&name) != 0) return "unknown";
    return std::string(name.sysname) + " " + name.release + " " + name.machine;
}

constexpr const char* kCompiler =
#if defined(__clang__)
    "Clang " __clang_version__;
#elif defined(__GNUC__)
    "GCC " __VERSION__;
#else
    "unknown";
#endif

}  // namespace

Machine this_machine() {
    Machine machine;
    machine.cpu = value_in("/proc/cpuinfo", "model name");
    if (machine.cpu.empty()) machine.cpu = "unknown";
    machine.simd = simd_target_name();
    machine.system = system_name();
    machine.compiler = kCompiler;
    machine.threads = tbb::this_task_arena::max_concurrency();
    return machine;
}

}  // namespace trapeze
