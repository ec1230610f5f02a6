/// What browsers are answered: the page that shows a run's pictures, and what it asks for.
///
/// "/" is the page, with /page.css and /page.js; it needs nothing from anywhere else. It asks for
/// - /state?after=V&page=ID&have=P.S: how far the run is, as JSON, once its version is greater than V, or
///   after a second. ID is the page's own; it has the changes of picture P up to version S, of all channels.
/// - /tiles?picture=P&after=S&channels=R,G,B&page=ID: changes of a picture since its version S, at most some
///   16 MiB: the number of tiles and the version that they lead to as 64-bit integers, then of each tile x,
///   y, width and height as 32-bit integers, and its floats, channel after channel, row by row;
///   little-endian.
/// - /view?picture=P&page=ID: the picture's ViewCube as floats; 404 where it has none.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>

#include "pipeline/preview/preview_board.h"
#include "pipeline/preview/web_server.h"

namespace trapeze {

/// Thread-safe.
class WebPages {
  public:
    /// `version`: of the program.
    WebPages(const PreviewBoard& board, std::string version);

    /// Requests that call the server by another name than this machine's own are refused, and those of other
    /// pages: they are to read nothing here, and to hold nobody up.
    WebAnswer answer(const WebRequest& request);

    /// Whether every page that is still there has all of the last picture.
    bool everybody_has_all() const;

  private:
    using Clock = std::chrono::steady_clock;
    /// A page that has asked for nothing for so long is gone.
    static constexpr std::chrono::milliseconds kGone{2000};
    /// An open page, as its requests tell.
    struct Page {
        Clock::time_point seen;  ///< when it asked for something last, or was answered
        int waits = 0;           ///< for so many answers
        bool has_all = false;

        bool is_gone(Clock::time_point now) const { return waits == 0 && now - seen > kGone; }
    };
    /// A request of a page that is being answered.
    class Asking {
      public:
        Asking(WebPages& pages, std::string id);
        ~Asking();
        Asking(const Asking&) = delete;
        Asking& operator=(const Asking&) = delete;

      private:
        WebPages& pages_;
        const std::string id_;
    };
    WebAnswer state(const WebRequest& request);
    WebAnswer tiles(const WebRequest& request) const;
    WebAnswer view(const WebRequest& request) const;
    PreviewEntry asked_picture(const WebRequest& request) const;
    void note_request(const std::string& page, const std::string& have);
    void note_waiting(const std::string& page, int more);

    const PreviewBoard& board_;
    const std::string version_;
    const std::string run_;  ///< differs from run to run
    mutable std::mutex mutex_;
    std::map<std::string, Page> pages_;
};

}  // namespace trapeze
