/// What a file with a visibility method of its own includes, to be loaded by `--plugin` [decision 0040]. It
/// is built against the headers of the program that loads it, and ends with
///
///     TRAPEZE_PLUGIN(my_method)
///
/// where my_method() gives the row for the table of methods. docs/examples/plugin is a whole one.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sample/visibility.h"

namespace trapeze {

/// Tells apart structures of other sizes than these headers': what a build of the same version, but of other
/// sources, may have. A hash and no proof: fields of the same size that change places go unnoticed.
constexpr uint64_t plugin_layout() {
    uint64_t layout = 0;
    for (const size_t size :
         {sizeof(Grid), sizeof(Grids), sizeof(Camera), sizeof(Options), sizeof(RenderContext),
          sizeof(SampleTile), sizeof(AxisRay), sizeof(HitBuffer), sizeof(SampleScratch), sizeof(SampleStats),
          sizeof(BuildStats), sizeof(MethodSpec), sizeof(VisibilityMethod)})
        layout = layout * 1'000'003 + size;
    return layout;
}

}  // namespace trapeze

/// The version as a text; the compiler's command line has it without quotes (-DTRAPEZE_PLUGIN_VERSION=0.1.0,
/// `pkg-config --cflags trapeze-plugin`).
#define TRAPEZE_PLUGIN_TEXT_OF(words) #words
#define TRAPEZE_PLUGIN_TEXT(macro) TRAPEZE_PLUGIN_TEXT_OF(macro)

/// What the program looks for. Nothing else of the file has to be visible.
#define TRAPEZE_PLUGIN(row)                                                                                 \
    extern "C" {                                                                                            \
    extern __attribute__((visibility("default"))) const char trapeze_plugin_version[];                      \
    const char trapeze_plugin_version[] = TRAPEZE_PLUGIN_TEXT(TRAPEZE_PLUGIN_VERSION);                      \
    extern __attribute__((visibility("default"))) const uint64_t trapeze_plugin_layout;                     \
    const uint64_t trapeze_plugin_layout = ::trapeze::plugin_layout();                                      \
    __attribute__((visibility("default"))) void trapeze_plugin_method(::trapeze::VisibilityMethod* method); \
    void trapeze_plugin_method(::trapeze::VisibilityMethod* method) {                                       \
        *method = row();                                                                                    \
    }                                                                                                       \
    }
