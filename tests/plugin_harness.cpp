/// Plugins that are refused: of an old version, with other headers (PLUGIN_LAYOUT), or of a name that is
/// taken.
#include "sample/plugin.h"

namespace {

trapeze::VisibilityMethod method_of_a_taken_name() {
    return {"raytrace",
            trapeze::MethodKind::Reference,
            {},
            trapeze::stratified_pattern,
            trapeze::any_pattern,
            [](const trapeze::VisibilityInput&) { return std::unique_ptr<trapeze::Visibility>(); }};
}

}  // namespace

#ifdef PLUGIN_LAYOUT
extern "C" {
#define SHOWN extern __attribute__((visibility("default")))
SHOWN const char trapeze_plugin_version[];
const char trapeze_plugin_version[] = TRAPEZE_PLUGIN_TEXT(TRAPEZE_PLUGIN_VERSION);
SHOWN const uint64_t trapeze_plugin_layout;
const uint64_t trapeze_plugin_layout = PLUGIN_LAYOUT;
SHOWN void trapeze_plugin_method(trapeze::VisibilityMethod* method);
void trapeze_plugin_method(trapeze::VisibilityMethod* method) {
    *method = method_of_a_taken_name();
}
}
#else
TRAPEZE_PLUGIN(method_of_a_taken_name)
#endif
