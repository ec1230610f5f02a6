#include "pipeline/preview/web_viewer.h"

#include <fmt/format.h>

#include "pipeline/frame/version.h"

namespace trapeze {
namespace {

/// The ports that are tried where the user names none: beside tev's.
constexpr int kFirstPort = 14159, kLastPort = 14168;
/// Pages are looked after so often at the end.
constexpr std::chrono::milliseconds kLookAfterPages{10};

}  // namespace

WebViewer::WebViewer(const PreviewBoard& board)
    : board_(board), pages_(board, std::string("Trapeze ") + kVersion) {}

WebViewer::~WebViewer() = default;

std::unique_ptr<WebViewer> WebViewer::open(const PreviewBoard& board, int port, std::string* problem) {
    const WebLibrary* const library = web_library(problem);
    if (!library) return {};
    std::unique_ptr<WebViewer> viewer(new WebViewer(board));
    viewer->server_ = library->serve(
        port ? port : kFirstPort, port ? port : kLastPort,
        [pages = &viewer->pages_](const WebRequest& request) { return pages->answer(request); }, problem);
    return viewer->server_ ? std::move(viewer) : nullptr;
}

std::string WebViewer::address() const {
    return fmt::format("http://127.0.0.1:{}/", server_->port());
}

void WebViewer::finish() {
    while (!pages_.everybody_has_all() && board_.time_for_viewers().count() > 0)
        std::this_thread::sleep_for(kLookAfterPages);
    server_.reset();
}

}  // namespace trapeze
