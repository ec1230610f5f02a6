/// A module that tests open, by three names: "harness", "old", and others that it does not have.
#include "core/files/module.h"

namespace {
constexpr int kOffered = 42;
}

extern "C" {
extern const trapeze::ModuleEntry trapeze_harness_module, trapeze_old_module;
const trapeze::ModuleEntry trapeze_harness_module = {TRAPEZE_VERSION, &kOffered};
const trapeze::ModuleEntry trapeze_old_module = {"0.0.1", &kOffered};
}
