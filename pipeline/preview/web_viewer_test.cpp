/// The page as it comes over a connection, and others that keep a connection open.
#include "pipeline/preview/web_viewer.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "pipeline/preview/preview_harness.h"

namespace trapeze {
namespace {

using testing::make_preview_picture;
using testing::NumberedPicture;
using Clock = std::chrono::steady_clock;

/// A browser's side of one connection to a viewer.
class Connection {
  public:
    /// `room`: bytes that come before they are heard; 0: what the system gives. Nothing is waited for longer
    /// than a minute.
    explicit Connection(const WebViewer& viewer, int room = 0)
        : file_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        if (room > 0) setsockopt(file_, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
        const timeval minute{60, 0};
        setsockopt(file_, SOL_SOCKET, SO_RCVTIMEO, &minute, sizeof minute);
        const std::string at = viewer.address();
        sockaddr_in address{};
        address.sin_family = AF_INET, address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        address.sin_port = htons(static_cast<uint16_t>(std::stoi(at.substr(at.rfind(':') + 1))));
        if (connect(file_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
            throw std::runtime_error("nobody serves at " + at);
    }
    ~Connection() { close(file_); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    bool say(std::string_view text) {
        return send(file_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
    }
    /// Until the other side has hung up; `pause` after each 16 KiB.
    std::string hear(std::chrono::milliseconds pause = {}) {
        std::string heard;
        std::vector<char> bytes(size_t{1} << 14);
        for (ssize_t got = 0; (got = recv(file_, bytes.data(), bytes.size(), 0)) > 0;) {
            heard.append(bytes.data(), static_cast<size_t>(got));
            std::this_thread::sleep_for(pause);
        }
        return heard;
    }
    void hang_up() { shutdown(file_, SHUT_RDWR); }

  private:
    const int file_;
};

std::unique_ptr<WebViewer> open_viewer(const PreviewBoard& board) {
    std::string problem;
    auto viewer = WebViewer::open(board, 0, &problem);
    EXPECT_TRUE(viewer) << problem;
    return viewer;
}

constexpr const char* kRequest = "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";

TEST(WebViewer, ThePageComesWhole) {
    PreviewBoard board;
    const auto viewer = open_viewer(board);
    ASSERT_TRUE(viewer);
    Connection browser(*viewer);
    ASSERT_TRUE(browser.say(kRequest));
    const std::string heard = browser.hear();
    EXPECT_EQ(heard.find("HTTP/1.1 200 OK\r\n"), 0u) << heard.substr(0, 200);
    EXPECT_NE(heard.find("frame-ancestors 'none'"), std::string::npos);
    EXPECT_NE(heard.find("</html>"), std::string::npos);
    board.end();
    viewer->finish();
}

TEST(WebViewer, SomebodyElsesPagesAreRefusedOverAConnectionToo) {
    PreviewBoard board;
    const auto viewer = open_viewer(board);
    ASSERT_TRUE(viewer);
    for (const std::string header : {"Origin: http://example.org", "Sec-Fetch-Site: cross-site"}) {
        Connection browser(*viewer);
        ASSERT_TRUE(browser.say("GET /state?page=1 HTTP/1.1\r\nHost: 127.0.0.1\r\n" + header + "\r\n\r\n"));
        EXPECT_EQ(browser.hear().find("HTTP/1.1 403 "), 0u) << header;
    }
}

/// Says its request a byte at a time, for as long as anybody listens.
TEST(WebViewer, OneWhoNeverEndsItsRequestIsLeft) {
    PreviewBoard board;
    const auto viewer = open_viewer(board);
    ASSERT_TRUE(viewer);
    const auto begun = Clock::now();
    Connection slow(*viewer);
    std::string heard;
    std::thread listener([&] { heard = slow.hear(); });
    for (int i = 0; i < 600 && slow.say("x"); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_LT(Clock::now() - begun, std::chrono::seconds(20));  // a second; the rest is for busy machines
    slow.hang_up();
    listener.join();
    EXPECT_EQ(heard.find("HTTP/1.1 200"), std::string::npos);
}

TEST(WebViewer, TheEndWaitsForNobodyWhoSaysLittle) {
    PreviewBoard board;
    auto viewer = open_viewer(board);
    ASSERT_TRUE(viewer);
    Connection slow(*viewer), silent(*viewer), last(*viewer);
    std::atomic<bool> done{false};
    std::thread says([&] {
        while (!done && slow.say("x")) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    });
    // Who comes later is heard later: the others have somebody who listens to them.
    ASSERT_TRUE(last.say(kRequest));
    ASSERT_FALSE(last.hear().empty());
    board.end();
    const auto begun = Clock::now();
    viewer->finish();
    viewer.reset();
    EXPECT_LT(Clock::now() - begun, std::chrono::seconds(15));
    done = true;
    says.join();
}

/// It would take nine seconds for what it asked for.
TEST(WebViewer, TheEndWaitsForNobodyWhoHearsLittle) {
    PreviewBoard board;
    auto viewer = open_viewer(board);
    ASSERT_TRUE(viewer);
    const NumberedPicture numbers({0, 0, 1600, 1200}, 5);
    const auto picture = make_preview_picture(numbers.window, "a.exr", 1600, 1200);
    board.begin_picture({0, picture, {}, 0});
    picture->finish(numbers.source());
    Connection slow(*viewer, 1 << 16);
    ASSERT_TRUE(
        slow.say("GET /tiles?picture=1&channels=R,G,B,A,Z&after=0 HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"));
    std::string heard;
    std::atomic<bool> hears{false};
    std::thread listener([&] {
        hears = true;
        heard = slow.hear(std::chrono::milliseconds(10));
    });
    while (!hears) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    board.end();
    viewer->finish();
    viewer.reset();
    listener.join();
    EXPECT_EQ(heard.find("HTTP/1.1 200 OK\r\n"), 0u);
    EXPECT_LT(heard.size(), size_t{16} << 20);  // of an answer of that many bytes and more
}

}  // namespace
}  // namespace trapeze
