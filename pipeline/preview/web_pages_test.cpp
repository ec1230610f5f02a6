#include "pipeline/preview/web_pages.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

#include "pipeline/preview/preview_harness.h"
#include "pipeline/preview/view_cube.h"

namespace trapeze {
namespace {

using testing::make_preview_picture;
using testing::NumberedPicture;

const PixelRect kSeen{5, 3, 60, 45};

WebAnswer ask(WebPages& pages, const std::string& path, std::map<std::string, std::string> parameters = {}) {
    return pages.answer({path, "127.0.0.1:14159", std::move(parameters)});
}

nlohmann::json state_of(WebPages& pages, std::map<std::string, std::string> parameters = {}) {
    const WebAnswer answer = ask(pages, "/state", std::move(parameters));
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.type, "application/json");
    return nlohmann::json::parse(answer.body);
}

/// Tiles as a page reads them.
struct Tiles {
    uint64_t count = 0, version = 0;
    std::vector<PixelRect> pixels;
    std::vector<std::vector<float>> values;

    explicit Tiles(const std::string& body, size_t channels) {
        size_t at = 0;
        const auto read = [&](void* to, size_t bytes) {
            ASSERT_LE(at + bytes, body.size());
            std::memcpy(to, body.data() + at, bytes);
            at += bytes;
        };
        read(&count, sizeof count), read(&version, sizeof version);
        for (uint64_t t = 0; t < count; ++t) {
            int32_t place[4] = {};
            read(place, sizeof place);
            pixels.push_back({place[0], place[1], place[0] + place[2], place[1] + place[3]});
            values.emplace_back(channels * static_cast<size_t>(place[2]) * static_cast<size_t>(place[3]));
            read(values.back().data(), values.back().size() * sizeof(float));
        }
        EXPECT_EQ(at, body.size());
    }
};

TEST(WebPages, ThePageNeedsNothingFromElsewhere) {
    PreviewBoard board;
    WebPages pages(board, "Trapeze 1");
    for (const char* path : {"/", "/page.css", "/page.js"}) {
        const WebAnswer answer = ask(pages, path);
        EXPECT_EQ(answer.status, 200);
        EXPECT_EQ(answer.body.find("http://"), std::string::npos) << path;
        EXPECT_EQ(answer.body.find("https://"), std::string::npos) << path;
        EXPECT_GT(answer.body.size(), 500u);
    }
    EXPECT_EQ(ask(pages, "/").type, "text/html; charset=utf-8");
    EXPECT_EQ(ask(pages, "/../etc/passwd").status, 404);
    EXPECT_EQ(ask(pages, "").status, 404);
}

TEST(WebPages, OtherNamesForThisMachineAreRefused) {
    PreviewBoard board;
    WebPages pages(board, "Trapeze 1");
    for (const char* host : {"127.0.0.1:14159", "localhost:80", "localhost", "127.0.0.1"})
        EXPECT_EQ(pages.answer({"/", host, {}}).status, 200) << host;
    for (const char* host : {"", "evil.example", "evil.example:14159", "127.0.0.1.evil.example", "127.0.0.2"})
        EXPECT_EQ(pages.answer({"/state", host, {}}).status, 403) << host;
}

TEST(WebPages, TheStateIsThatOfTheRun) {
    PreviewBoard board;
    WebPages pages(board, "Trapeze 1");
    nlohmann::json state = state_of(pages);
    EXPECT_TRUE(state["picture"].is_null());
    EXPECT_FALSE(state["ended"]);

    const auto picture = make_preview_picture(kSeen, "b\xff.exr");
    board.begin_picture({0, picture, {}, 7});
    board.begin_stage("trace");
    board.progress(0.25);
    state = state_of(pages);
    EXPECT_EQ(state["stage"], "trace");
    EXPECT_EQ(state["fraction"], 0.25);
    EXPECT_TRUE(state["left"].is_number());
    EXPECT_EQ(state["program"], "Trapeze 1");
    const nlohmann::json& facts = state["picture"];
    EXPECT_EQ(facts["number"], 1);
    EXPECT_EQ(facts["name"], "b\xef\xbf\xbd.exr");
    EXPECT_EQ(facts["frame"], 7);
    EXPECT_EQ(facts["window"], (nlohmann::json{5, 3, 60, 45}));
    EXPECT_EQ(facts["channels"].size(), 5u);
    EXPECT_FALSE(facts["finished"]);
    EXPECT_TRUE(facts["view"].is_null());

    picture->finish(NumberedPicture(kSeen, 5).source());
    board.end();
    state = state_of(pages, {{"after", std::to_string(state["version"].get<int>())}});
    EXPECT_TRUE(state["ended"] && state["picture"]["finished"] && state["picture"]["closed"]);
}

TEST(WebPages, AStateIsAwaited) {
    PreviewBoard board;
    WebPages pages(board, "Trapeze 1");
    board.begin_stage("read");
    const auto version = state_of(pages)["version"].get<uint64_t>();
    std::thread later([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        board.begin_stage("trace");
    });
    EXPECT_EQ(state_of(pages, {{"after", std::to_string(version)}})["stage"], "trace");
    later.join();
}

TEST(WebPages, TilesAreSentOnceAndAsChosen) {
    const NumberedPicture numbers(kSeen, 5);
    PreviewBoard board;
    WebPages pages(board, "Trapeze 1");
    const auto picture = make_preview_picture(kSeen);
    board.begin_picture({0, picture, {}, 0});
    picture->put({16, 16, 32, 32}, numbers.source());
    std::map<std::string, std::string> asked{{"picture", "1"}, {"channels", "Z,G,nothing"}, {"after", "0"}};
    const Tiles first(ask(pages, "/tiles", asked).body, 2);
    ASSERT_EQ(first.count, 1u);
    EXPECT_EQ(first.pixels[0], (PixelRect{16, 16, 32, 32}));
    EXPECT_EQ(first.values[0][0], NumberedPicture::value(4, 16, 16));
    EXPECT_EQ(first.values[0][256 + 17], NumberedPicture::value(1, 17, 17));

    picture->finish(numbers.source());
    asked["after"] = std::to_string(first.version);
    const Tiles rest(ask(pages, "/tiles", asked).body, 2);
    EXPECT_EQ(rest.count, 11u);
    EXPECT_EQ(rest.version, picture->version());
    asked["after"] = std::to_string(rest.version);
    EXPECT_EQ(Tiles(ask(pages, "/tiles", asked).body, 2).count, 0u);

    EXPECT_EQ(ask(pages, "/tiles", {{"picture", "2"}}).status, 410);
    EXPECT_EQ(ask(pages, "/tiles", {{"picture", "x"}, {"after", "-3"}}).status, 410);
    EXPECT_EQ(ask(pages, "/tiles").status, 410);
}

/// A large picture comes in several answers, with nothing left out.
TEST(WebPages, AnAnswerIsNotEndless) {
    const PixelRect window{0, 0, 1600, 1200};
    const NumberedPicture numbers(window, 5);
    PreviewBoard board;
    WebPages pages(board, "Trapeze 1");
    const auto picture = make_preview_picture(window, "a.exr", 1600, 1200);
    board.begin_picture({0, picture, {}, 0});
    picture->finish(numbers.source());
    uint64_t version = 0, tiles = 0;
    int answers = 0;
    for (;; ++answers) {
        const WebAnswer answer =
            ask(pages, "/tiles",
                {{"picture", "1"}, {"channels", "R,G,B,A,Z"}, {"after", std::to_string(version)}});
        EXPECT_LT(answer.body.size(), size_t{17} << 20);
        const Tiles some(answer.body, 5);
        if (some.count == 0) break;
        version = some.version, tiles += some.count;
    }
    EXPECT_EQ(answers, 3);
    EXPECT_EQ(tiles, 7500u);
}

/// Colours by no library: all that pages ask of one.
class HalfAsBright final : public ColorManagement, public ColorTransform {
  public:
    const ColorNames& names() const override { return names_; }
    const ColorTransform& view() const override { return *this; }
    bool view_is_srgb() const override { return false; }
    std::string space_named(std::string_view) const override { return {}; }
    std::string spaces_listed() const override { return {}; }
    std::string space_of_file(const std::string&) const override { return {}; }
    std::shared_ptr<const ColorTransform> from_space(const std::string&, std::string*) const override {
        return {};
    }
    void apply(float* rgba, size_t pixels) const override {
        for (size_t i = 0; i < 4 * pixels; ++i) rgba[i] /= 2;
    }

  private:
    ColorNames names_{"work", "screen", "dim", ""};
};

TEST(WebPages, AViewIsATable) {
    PreviewBoard board;
    WebPages pages(board, "Trapeze 1");
    board.begin_picture({0, make_preview_picture(kSeen), {}, 0});
    EXPECT_EQ(ask(pages, "/view", {{"picture", "1"}}).status, 404);
    board.begin_picture({0, make_preview_picture(kSeen), std::make_shared<HalfAsBright>(), 0});
    const nlohmann::json view = state_of(pages)["picture"]["view"];
    EXPECT_EQ(view["view"], "dim");
    const std::string table = ask(pages, "/view", {{"picture", "2"}}).body;
    const auto side = view["side"].get<size_t>();
    ASSERT_EQ(table.size(), side * side * side * 3 * sizeof(float));
    float last = 0;
    std::memcpy(&last, table.data() + table.size() - sizeof last, sizeof last);
    EXPECT_NEAR(last, view["most"].get<float>() / 2, 1e-3f);
}

TEST(WebPages, ThePagesThatAreOpenAreWaitedFor) {
    const NumberedPicture numbers(kSeen, 5);
    PreviewBoard board;
    WebPages pages(board, "Trapeze 1");
    EXPECT_TRUE(pages.everybody_has_all());
    const auto picture = make_preview_picture(kSeen);
    board.begin_picture({0, picture, {}, 0});
    picture->put({16, 16, 32, 32}, numbers.source());
    state_of(pages, {{"page", "a"}});
    state_of(pages, {{"page", "b"}});
    EXPECT_FALSE(pages.everybody_has_all());
    picture->finish(numbers.source());
    board.end();
    const std::string all = "1." + std::to_string(picture->version());
    state_of(pages, {{"page", "a"}, {"have", "1.1"}});
    EXPECT_FALSE(pages.everybody_has_all());
    state_of(pages, {{"page", "a"}, {"have", all}});
    EXPECT_FALSE(pages.everybody_has_all());
    state_of(pages, {{"page", "b"}, {"have", all}});
    EXPECT_TRUE(pages.everybody_has_all());
}

/// A page of somebody else's in the same browser cannot read answers, but it could ask.
TEST(WebPages, OtherPagesAreRefusedAndHoldNobodyUp) {
    PreviewBoard board;
    WebPages pages(board, "Trapeze 1");
    board.begin_picture({0, make_preview_picture(kSeen), {}, 0});
    const auto status = [&](const char* path, const char* site, const char* origin) {
        return pages.answer({path, "127.0.0.1:14159", {{"page", "x"}, {"picture", "1"}}, site, origin})
            .status;
    };
    for (const char* path : {"/state", "/tiles", "/view", "/page.js"}) {
        EXPECT_EQ(status(path, "cross-site", ""), 403) << path;
        EXPECT_EQ(status(path, "same-site", ""), 403) << path;  // another port of this machine
        EXPECT_EQ(status(path, "", "http://example.com"), 403) << path;
        EXPECT_EQ(status(path, "", "null"), 403) << path;
    }
    EXPECT_TRUE(pages.everybody_has_all());
    EXPECT_EQ(status("/", "cross-site", ""), 200);  // a link to the page
    EXPECT_EQ(status("/state", "same-origin", "http://127.0.0.1:14159"), 200);
    EXPECT_EQ(status("/tiles", "none", ""), 200);
    EXPECT_FALSE(pages.everybody_has_all());
}

TEST(WebPages, APageThatIsStillFetchingIsThere) {
    const NumberedPicture numbers(kSeen, 5);
    PreviewBoard board;
    WebPages pages(board, "Trapeze 1");
    const auto picture = make_preview_picture(kSeen);
    board.begin_picture({0, picture, {}, 0});
    picture->finish(numbers.source());
    board.end();
    state_of(pages, {{"page", "a"}});
    const auto begun = std::chrono::steady_clock::now();
    // For longer than a page that says nothing is taken to be there.
    while (std::chrono::steady_clock::now() - begun < std::chrono::milliseconds(2500)) {
        EXPECT_EQ(ask(pages, "/tiles", {{"picture", "1"}, {"channels", "R"}, {"page", "a"}}).status, 200);
        EXPECT_FALSE(pages.everybody_has_all());
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
}

TEST(WebPages, APageThatIsGoneIsNotWaitedFor) {
    PreviewBoard board;
    WebPages pages(board, "Trapeze 1");
    board.begin_picture({0, make_preview_picture(kSeen), {}, 0});
    state_of(pages, {{"page", "a"}});
    EXPECT_FALSE(pages.everybody_has_all());
    while (!pages.everybody_has_all()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

}  // namespace
}  // namespace trapeze
