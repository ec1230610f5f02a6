#include "pipeline/cli/commands/run_preview.h"

#include <fmt/format.h>

#include "pipeline/frame/frame_memory.h"
#include "pipeline/preview/tev_viewer.h"
#include "pipeline/preview/web_viewer.h"

namespace trapeze {
namespace {

/// Pictures that are kept for slow viewers take at most this part of the memory, beside the last one.
constexpr size_t kKeptShare = 8;

}  // namespace

std::unique_ptr<Preview> preview_of(const Arguments& arguments, Terminal& terminal,
                                    Diagnostics& diagnostics) {
    if (arguments.previews.empty()) return {};
    const size_t budget = arguments.memory_bytes ? arguments.memory_bytes : default_memory_budget();
    auto preview = std::make_unique<Preview>(budget / kKeptShare);
    for (const ViewerAddress& address : arguments.previews) {
        if (address.kind == ViewerAddress::Kind::Tev) {
            const auto report = [&diagnostics](const std::string& problem) { diagnostics.note({}, problem); };
            preview->add(std::make_unique<TevViewer>(preview->board(), address.host, address.port, report));
            continue;
        }
        std::string problem;
        auto page = WebViewer::open(preview->board(), address.port, &problem);
        if (!page) {
            diagnostics.note({}, fmt::format("--preview web: no page is shown: {}", problem));
            continue;
        }
        terminal.say(fmt::format("the picture can be watched at {}", page->address()));
        preview->add(std::move(page));
    }
    return preview;
}

}  // namespace trapeze
