/// `trapeze render --preview`: viewers of all kinds, those that are not there, and those that go away.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "pipeline/preview/mock_tev_harness.h"
#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

constexpr const char* kLargeSphere = "render sphere.rib -r 640x480 --samples 8 ";

/// Pictures then have no times in them.
Outcome render_sphere(const WorkFolder& folder, const std::string& options) {
    std::string scene = kSphereScene;
    scene.erase(scene.find("rgbaz") + 4, 1);
    folder.write("sphere.rib", scene);
    return run_program(folder, kLargeSphere + options, "env SOURCE_DATE_EPOCH=1000000000");
}

/// A picture without its words, which have the command line in them.
std::string pixels_of(const WorkFolder& folder, const std::string& options) {
    EXPECT_EQ(render_sphere(folder, options + " -o out.tif --driver tiff --transfer linear").exit_code, 0)
        << options;
    return file_text(folder / "out.tif");
}

/// A socket that is bound to a port of this machine.
class TakenPort {
  public:
    TakenPort() {
        file_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET, address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        EXPECT_EQ(bind(file_, reinterpret_cast<const sockaddr*>(&address), size), 0);
        EXPECT_EQ(getsockname(file_, reinterpret_cast<sockaddr*>(&address), &size), 0);
        port_ = ntohs(address.sin_port);
    }
    ~TakenPort() { release(); }
    void listen_at_it() { EXPECT_EQ(listen(file_, 1), 0); }
    void release() {
        if (file_ >= 0) close(file_);
        file_ = -1;
    }
    int port() const { return port_; }

  private:
    int file_ = -1, port_ = 0;
};

/// What a server of this machine answers to a request; empty where there is none.
std::string ask(int port, const std::string& path, const std::string& host = "127.0.0.1",
                const std::string& method = "GET") {
    const int file = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET, address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<uint16_t>(port));
    std::string answer;
    if (connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
        const std::string request = method + " " + path + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n";
        send(file, request.data(), request.size(), MSG_NOSIGNAL);
        char bytes[1 << 14];
        for (ssize_t got = 0; (got = recv(file, bytes, sizeof bytes, 0)) > 0;)
            answer.append(bytes, static_cast<size_t>(got));
    }
    close(file);
    return answer;
}

std::string body_of(const std::string& answer) {
    const size_t end = answer.find("\r\n\r\n");
    return end == answer.npos ? std::string() : answer.substr(end + 4);
}

TEST(CommandLinePreview, ATevIsSentThePictureAndNothingElseChanges) {
    const WorkFolder folder;
    const std::string plain = pixels_of(folder, "");
    MockTev tev;
    EXPECT_EQ(pixels_of(folder, "--preview " + tev.address()), plain);
    const TevImages& shown = tev.stop();
    ASSERT_EQ(shown.created, std::vector<std::string>{"out.tif"});
    const TevImage& image = shown.images.at("out.tif");
    EXPECT_EQ(image.width, 640);
    EXPECT_EQ(image.channels.size(), 5u);
    EXPECT_GE(image.updates, 40u * 30);
    // The sphere's middle is seen, the corner is not.
    EXPECT_EQ(image.channels.at("A")[240 * 640 + 320], 1);
    EXPECT_EQ(image.channels.at("A")[0], 0);
}

TEST(CommandLinePreview, NobodyThereIsToldAndChangesNothing) {
    const WorkFolder folder;
    const std::string plain = pixels_of(folder, "");
    TakenPort taken;
    const std::string port = std::to_string(taken.port());
    EXPECT_EQ(pixels_of(folder, "--strict --preview tev:" + port), plain);
    EXPECT_NE(file_text(folder / ".stderr").find("tev at 127.0.0.1:" + port + " shows nothing"),
              std::string::npos)
        << file_text(folder / ".stderr");
    taken.listen_at_it();
    EXPECT_EQ(pixels_of(folder, "--strict --preview web:" + port), plain);
    EXPECT_NE(file_text(folder / ".stderr").find("port " + port + " is taken"), std::string::npos);
    EXPECT_EQ(pixels_of(folder, "--strict --preview tev:no.such.host.invalid:9"), plain);
}

TEST(CommandLinePreview, AViewerThatVanishesOrStallsChangesNothing) {
    const WorkFolder folder;
    const std::string plain = pixels_of(folder, "");
    MockTev quitting(7), stalled(0, MockTev::Reads::Nothing);
    EXPECT_EQ(pixels_of(folder, "--preview " + quitting.address() + " --preview " + stalled.address()),
              plain);
    quitting.stop(), stalled.stop();
}

TEST(CommandLinePreview, OtherViewersAreNotKnown) {
    const WorkFolder folder;
    for (const char* viewer : {"it", "tev:", "tev:host", "web:0", "web:x"}) {
        EXPECT_EQ(render_sphere(folder, std::string("-o a.exr --preview ") + viewer).exit_code, 2) << viewer;
        EXPECT_NE(file_text(folder / ".stderr").find("--preview"), std::string::npos);
    }
}

/// A browser without a window.
TEST(CommandLinePreview, APageIsServedToThisMachineWhileThePictureIsMade) {
    const WorkFolder folder;
    TakenPort taken;
    const int port = taken.port();
    taken.release();
    std::thread run([&] {
        EXPECT_EQ(
            render_sphere(folder, "-o a.exr --samples 24 --preview web:" + std::to_string(port)).exit_code,
            0);
    });
    nlohmann::json state;
    std::string page, refused, posted, tiles;
    bool was_unfinished = false;
    uint64_t version = 0;
    while (state.is_null() || !state["ended"].get<bool>()) {
        const std::string last = state.is_null() || state["picture"].is_null()
                                     ? ""
                                     : std::to_string(state["picture"]["version"].get<uint64_t>());
        const std::string body =
            body_of(ask(port, "/state?page=a&have=1." + last + "&after=" + std::to_string(version)));
        if (body.empty()) {
            if (!state.is_null()) break;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            continue;
        }
        state = nlohmann::json::parse(body);
        version = state["version"];
        if (state["picture"].is_null()) continue;
        was_unfinished = was_unfinished || !state["picture"]["finished"].get<bool>();
        if (page.empty()) {
            page = ask(port, "/");
            refused = ask(port, "/", "evil.example");
            posted = ask(port, "/", "127.0.0.1", "POST");
        }
        // Once it is told that this page has all, the program may go.
        const std::string now = body_of(ask(port, "/tiles?picture=1&after=0&channels=R,G,B"));
        if (!now.empty()) tiles = now;
    }
    run.join();
    EXPECT_TRUE(was_unfinished);
    EXPECT_NE(page.find("HTTP/1.1 200"), std::string::npos) << page;
    EXPECT_NE(page.find("default-src 'self'"), std::string::npos);
    EXPECT_NE(page.find("<canvas"), std::string::npos);
    EXPECT_NE(refused.find("HTTP/1.1 403"), std::string::npos) << refused;
    EXPECT_NE(posted.find("HTTP/1.1 405"), std::string::npos) << posted;
    EXPECT_EQ(tiles.size(), 16 + 16 * 1200 + sizeof(float) * 3 * 640 * 480);
    EXPECT_NE(file_text(folder / ".stderr").find("http://127.0.0.1:" + std::to_string(port) + "/"),
              std::string::npos);
    EXPECT_TRUE(ask(port, "/").empty());
}

}  // namespace
}  // namespace trapeze::testing
