/// Tests that run once for each instruction set of the machine.
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

namespace trapeze::testing {

/// Runs the body once for each target that this machine has and that kernels were compiled for, it alone
/// chosen; afterwards all may be chosen again.
template <class Body>
void for_each_target(const Body& body) {
    const int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
    EXPECT_NE(supported, 0);
    for (int64_t left = supported; left != 0; left &= left - 1) {
        const int64_t target = left & -left;
        SCOPED_TRACE(hwy::TargetName(target));
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        body();
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace trapeze::testing
