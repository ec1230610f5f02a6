#include "pipeline/preview/tev_viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <numeric>

#include "pipeline/preview/tev_packets.h"

namespace trapeze {
namespace {

/// For so long a viewer may take nothing while a run goes on, as somebody moves its window about; and when
/// the run has ended, and waits for it.
constexpr std::chrono::seconds kPatience{30}, kPatienceAtEnd{1};
/// A picture's changes are looked for so often where nobody says that there are any.
constexpr std::chrono::milliseconds kLook{500};
/// A tev that is not there is asked again after this.
constexpr std::chrono::seconds kTryAgain{2};

}  // namespace

TevViewer::TevViewer(const PreviewBoard& board, std::string host, int port,
                     std::function<void(const std::string&)> report)
    : board_(board),
      host_(std::move(host)),
      port_(port),
      report_(std::move(report)),
      socket_([this]() -> std::chrono::milliseconds {
          if (!board_.status().ended) return kPatience;
          return std::min<std::chrono::milliseconds>(kPatienceAtEnd, board_.time_for_viewers());
      }),
      thread_([this] {
          try {
              run();
          } catch (const std::bad_alloc&) {
              socket_.close();
              report_("tev shows no more: there is no memory for what it would be sent");
          }
      }) {}

TevViewer::~TevViewer() {
    finish();
}

void TevViewer::finish() {
    if (thread_.joinable()) thread_.join();
}

void TevViewer::run() {
    int number = 0;
    for (;;) {
        const PreviewEntry entry = board_.wait_for_picture_after(number);
        if (!entry.picture || gives_up_) return socket_.close();
        number = entry.number;
        show_once_there(entry);
    }
}

/// Shows a picture that is being made as soon as there is a tev, from its beginning to where it is.
void TevViewer::show_once_there(const PreviewEntry& entry) {
    for (;;) {
        const bool is_closed = entry.picture->is_closed(), has_ended = board_.status().ended;
        const bool is_there = socket_.is_open() || socket_.connect(host_, port_);
        const bool is_shown = is_there && show(entry);
        if (!is_shown && !fails_)
            report_(fmt::format("tev at {}:{} shows nothing: {}", host_, port_, socket_.problem()));
        fails_ = !is_shown;
        if (!is_shown && has_ended) gives_up_ = true;
        if (is_shown || is_closed || gives_up_) return;
        const auto until = std::chrono::steady_clock::now() + kTryAgain;
        while (!entry.picture->is_closed() && std::chrono::steady_clock::now() < until)
            std::this_thread::sleep_for(kLook / 5);
    }
}

/// Sends a picture until it is closed; false where tev is gone.
bool TevViewer::show(const PreviewEntry& entry) {
    const PreviewFacts& facts = entry.picture->facts();
    if (!socket_.send(tev_create_image(facts.name, facts.width, facts.height, facts.channels))) return false;
    std::vector<int> channels(facts.channels.size());
    std::iota(channels.begin(), channels.end(), 0);
    uint64_t version = 0, seen = 0;
    for (;;) {
        // Asked first: what a closed picture has it has for good.
        const bool is_closed = entry.picture->is_closed();
        if (!send_changes(entry, channels, version)) return false;
        if (is_closed) return true;
        seen = board_.wait(seen, kLook).version;
    }
}

bool TevViewer::send_changes(const PreviewEntry& entry, const std::vector<int>& channels, uint64_t& version) {
    const PreviewFacts& facts = entry.picture->facts();
    const PreviewPicture::Changes changes = entry.picture->changes_after(version);
    for (size_t i = 0; i < changes.pixels.size(); ++i) {
        const PixelRect& pixels = changes.pixels[i];
        const std::vector<float> values = entry.picture->values(pixels, channels);
        if (!socket_.send(tev_update_image(facts.name, facts.channels, pixels, values))) return false;
        version = changes.versions[i];
    }
    return true;
}

}  // namespace trapeze
