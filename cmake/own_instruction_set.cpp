// Prints Highway's name of the best instruction set that this machine has among those kernels are compiled for,
// or nothing. Run while the build is configured, for TRAPEZE_INSTRUCTION_SETS=own.
#include <hwy/targets.h>

#include <cstdio>

int main() {
#if HWY_ARCH_X86
    for (const int64_t target : {HWY_AVX3, HWY_AVX2, HWY_SSE4})
        if (hwy::SupportedTargets() & target) {
            std::fputs(hwy::TargetName(target), stdout);
            return 0;
        }
#endif
    return 0;
}
