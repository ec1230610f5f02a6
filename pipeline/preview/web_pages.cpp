#include "pipeline/preview/web_pages.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

#include "pipeline/preview/view_cube.h"

namespace trapeze {

extern const char* const kPreviewPage;
extern const char* const kPreviewStyle;
extern const char* const kPreviewScript;

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are sent as they lie in memory");

/// A page that is up to date is told so after this, so that it and the server know of each other.
constexpr std::chrono::milliseconds kLongestPoll{1000};
/// What changes for so long after a change is told together with it: a page that is not in front of all may
/// set no clock for less than a second, and asks again as soon as it is answered.
constexpr std::chrono::milliseconds kTogether{40};
/// An answer ends after the tile that brings it to so many bytes.
constexpr size_t kMostBytes = size_t{16} << 20;
/// Pages that are remembered; a stranger may make up as many as he likes.
constexpr size_t kMostPages = 64;

WebAnswer refusal(int status, std::string why) {
    return {status, "text/plain; charset=utf-8", std::move(why) + "\n"};
}

std::string parameter(const WebRequest& request, const std::string& name) {
    const auto found = request.parameters.find(name);
    return found == request.parameters.end() ? std::string() : found->second;
}

/// A parameter's number; 0 where it has none.
uint64_t number(std::string_view text) {
    uint64_t value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

/// Whether a browser that calls the server so has not been led here by somebody else's name for this machine.
bool is_own_name(std::string_view host) {
    if (const size_t colon = host.rfind(':'); colon != host.npos) host = host.substr(0, colon);
    return host == "127.0.0.1" || host == "localhost";
}

/// Whether a page that is not ours asks: it could read no answer, but keep the run waiting, and its threads
/// busy. The page itself may be led to from anywhere.
bool is_of_others(const WebRequest& request) {
    if (!request.origin.empty() && request.origin != "http://" + request.host) return true;
    return request.path != "/" && !request.site.empty() && request.site != "same-origin" &&
           request.site != "none";
}

template <class Number>
void append(std::string& bytes, Number value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append(std::string& bytes, const std::vector<float>& values) {
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
}

/// Places of channels by their names, which commas part; those that are not there are left out.
std::vector<int> channels_named(const PreviewFacts& facts, std::string_view names) {
    std::vector<int> places;
    while (!names.empty()) {
        const size_t comma = std::min(names.find(','), names.size());
        const std::string_view name = names.substr(0, comma);
        names.remove_prefix(std::min(comma + 1, names.size()));
        const auto found = std::ranges::find(facts.channels, name);
        if (found != facts.channels.end()) places.push_back(static_cast<int>(found - facts.channels.begin()));
    }
    return places;
}

/// Seconds that are left, where the part that is done tells.
nlohmann::json seconds_left(const PreviewStatus& status) {
    constexpr double kTooEarly = 0.03;
    if (status.fraction < kTooEarly) return nullptr;
    return status.seconds * (1 - status.fraction) / status.fraction;
}

nlohmann::json picture_json(const PreviewStatus& status) {
    const PreviewEntry& entry = status.entry;
    const PreviewFacts& facts = entry.picture->facts();
    nlohmann::json picture = {
        {"number", entry.number},
        {"name", facts.name},
        {"frame", entry.frame},
        {"width", facts.width},
        {"height", facts.height},
        {"window", {facts.window.x0, facts.window.y0, facts.window.x1, facts.window.y1}},
        {"channels", facts.channels},
        {"version", entry.picture->version()},
        {"finished", entry.picture->is_finished()},
        {"closed", entry.picture->is_closed()},
        {"view", nullptr}};
    if (entry.colors)
        picture["view"] = {{"display", entry.colors->names().display},
                           {"view", entry.colors->names().view},
                           {"look", entry.colors->names().look},
                           {"side", ViewCube::kSide},
                           {"toe", ViewCube::kToe},
                           {"most", ViewCube::kMost}};
    return picture;
}

}  // namespace

WebPages::WebPages(const PreviewBoard& board, std::string version)
    : board_(board),
      version_(std::move(version)),
      run_(fmt::format("{:x}-{:x}", getpid(), std::chrono::system_clock::now().time_since_epoch().count())) {}

WebAnswer WebPages::answer(const WebRequest& request) {
    if (!is_own_name(request.host)) return refusal(403, "this server is for this machine alone");
    if (is_of_others(request)) return refusal(403, "other pages are to ask for nothing here");
    if (request.path == "/") return {200, "text/html; charset=utf-8", kPreviewPage};
    if (request.path == "/page.css") return {200, "text/css; charset=utf-8", kPreviewStyle};
    if (request.path == "/page.js") return {200, "text/javascript; charset=utf-8", kPreviewScript};
    if (request.path == "/state") return state(request);
    const Asking asking(*this, parameter(request, "page"));
    if (request.path == "/tiles") return tiles(request);
    if (request.path == "/view") return view(request);
    return refusal(404, "there is no such page");
}

WebAnswer WebPages::state(const WebRequest& request) {
    const std::string page = parameter(request, "page");
    note_request(page, parameter(request, "have"));
    const Asking asking(*this, page);
    PreviewStatus status = board_.wait(number(parameter(request, "after")), kLongestPoll);
    if (!status.ended) {
        std::this_thread::sleep_for(kTogether);
        status = board_.status();
    }
    nlohmann::json json = {{"program", version_},
                           {"run", run_},
                           {"version", status.version},
                           {"stage", status.stage},
                           {"fraction", status.fraction},
                           {"seconds", status.seconds},
                           {"left", seconds_left(status)},
                           {"ended", status.ended},
                           {"picture", nullptr}};
    if (status.entry.picture) json["picture"] = picture_json(status);
    // Names of files need not be UTF-8.
    return {200, "application/json", json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

PreviewEntry WebPages::asked_picture(const WebRequest& request) const {
    return board_.picture(static_cast<int>(number(parameter(request, "picture"))));
}

WebAnswer WebPages::tiles(const WebRequest& request) const {
    const PreviewEntry entry = asked_picture(request);
    if (!entry.picture) return refusal(410, "that picture is not here any more");
    const std::vector<int> channels = channels_named(entry.picture->facts(), parameter(request, "channels"));
    uint64_t version = number(parameter(request, "after"));
    const PreviewPicture::Changes changes = entry.picture->changes_after(version);
    std::string body(2 * sizeof(uint64_t), '\0');
    uint64_t count = 0;
    for (; count < changes.pixels.size() && body.size() < kMostBytes; ++count) {
        const PixelRect& pixels = changes.pixels[count];
        for (const int value : {pixels.x0, pixels.y0, pixels.width(), pixels.height()})
            append(body, static_cast<int32_t>(value));
        append(body, entry.picture->values(pixels, channels));
        version = changes.versions[count];
    }
    std::memcpy(body.data(), &count, sizeof count);
    std::memcpy(body.data() + sizeof count, &version, sizeof version);
    return {200, "application/octet-stream", std::move(body)};
}

WebAnswer WebPages::view(const WebRequest& request) const {
    const PreviewEntry entry = asked_picture(request);
    if (!entry.picture || !entry.colors) return refusal(404, "that picture has no view");
    WebAnswer answer{200, "application/octet-stream", {}};
    append(answer.body, bake_view(entry.colors->view()).rgb);
    return answer;
}

void WebPages::note_request(const std::string& id, const std::string& have) {
    if (id.empty()) return;
    const PreviewEntry entry = board_.status().entry;
    const std::string all = entry.picture && entry.picture->is_closed()
                                ? fmt::format("{}.{}", entry.number, entry.picture->version())
                                : std::string();
    const std::lock_guard lock(mutex_);
    if (pages_.size() >= kMostPages)
        std::erase_if(pages_, [now = Clock::now()](const auto& page) { return page.second.is_gone(now); });
    if (pages_.size() >= kMostPages && !pages_.contains(id)) return;
    Page& page = pages_[id];
    page.seen = Clock::now();
    page.has_all = !entry.picture || (!all.empty() && have == all);
}

WebPages::Asking::Asking(WebPages& pages, std::string id) : pages_(pages), id_(std::move(id)) {
    pages_.note_waiting(id_, +1);
}

WebPages::Asking::~Asking() {
    pages_.note_waiting(id_, -1);
}

void WebPages::note_waiting(const std::string& id, int more) {
    const std::lock_guard lock(mutex_);
    const auto found = pages_.find(id);
    if (found == pages_.end()) return;
    found->second.seen = Clock::now();
    // A page may have been forgotten, and noted anew, while it waited.
    found->second.waits = std::max(0, found->second.waits + more);
}

bool WebPages::everybody_has_all() const {
    const std::lock_guard lock(mutex_);
    return std::ranges::all_of(pages_, [now = Clock::now()](const auto& entry) {
        const Page& page = entry.second;
        return page.has_all || page.is_gone(now);
    });
}

}  // namespace trapeze
