/// A page for browsers of this machine, which shows a run's pictures.
#pragma once

#include <memory>
#include <string>

#include "pipeline/preview/preview.h"
#include "pipeline/preview/web_pages.h"

namespace trapeze {

class WebViewer final : public PreviewViewer {
  public:
    /// `port`: 0: the first of the usual ones that is free. Null, and why, where the page cannot be served.
    static std::unique_ptr<WebViewer> open(const PreviewBoard& board, int port, std::string* problem);
    ~WebViewer() override;

    std::string address() const;

    /// Returns when all pages that are open have the last picture, as long as they go on asking for it.
    void finish() override;

  private:
    explicit WebViewer(const PreviewBoard& board);

    const PreviewBoard& board_;
    WebPages pages_;
    std::unique_ptr<WebServer> server_;
};

}  // namespace trapeze
