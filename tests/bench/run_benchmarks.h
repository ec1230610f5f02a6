/// Runs benchmarks with what they take besides Google Benchmark's own arguments.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>

#include "core/simd/simd_limit.h"

namespace trapeze {

/// Runs the benchmarks that the arguments choose; `--simd NAME` limits the instruction set, as the program's
/// option does. The program's exit code.
inline int run_benchmarks(int argc, char** argv) {
    for (int i = 1; i + 1 < argc; ++i) {
        if (std::strcmp(argv[i], "--simd") != 0) continue;
        std::string error;
        if (!limit_simd(argv[i + 1], &error)) {
            std::fprintf(stderr, "%s: %s\n", argv[0], error.c_str());
            return 2;
        }
        // Google Benchmark takes it for a mistake.
        std::copy(argv + i + 2, argv + argc, argv + i);
        argc -= 2;
        break;
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}

}  // namespace trapeze
