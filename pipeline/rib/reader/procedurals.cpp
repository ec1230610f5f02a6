/// Procedural primitives (RISpec 5.8): their geometry is read at once, within a block of their own.
#include <charconv>
#include <filesystem>
#include <sstream>

#include "pipeline/rib/programs/find_program.h"
#include "pipeline/rib/reader/reader.h"

namespace trapeze::rib {
namespace {

RequestText bare_request(const char* name, SourceLocation at) {
    RequestText request;
    request.name = name, request.at = at;
    return request;
}

}  // namespace

/// Runs `read` between AttributeBegin and AttributeEnd; blocks that it leaves open are closed.
template <class Read>
void Reader::read_in_block(Read&& read) {
    begin_block(Block::Attribute);
    hands_on(bare_request("AttributeBegin", at_));
    const size_t depth = blocks_.size();
    const auto id = blocks_.back().id;
    read();
    while (blocks_.size() > depth && blocks_[depth - 1].id == id) {
        error(std::string(block_name(blocks_.back().kind)) + " of line " +
              std::to_string(blocks_.back().at.line) + " is still open; closed here");
        close_block();
    }
    hands_on(bare_request("AttributeEnd", at_));
    // What was read may have closed this block too.
    if (blocks_.size() >= depth && blocks_[depth - 1].id == id) close_block();
}

bool Reader::takes_procedural() {
    if (motion_) throw RequestError{"inside a motion block", {}};
    return takes_geometry();
}

void Reader::delayed_archive(const std::string& name) {
    if (!takes_procedural()) return;
    read_in_block([&] { read_archive(name); });
}

void Reader::run_program(const std::string& command, const std::string& data,
                         const std::vector<float>& bound) {
    std::istringstream stream(command);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    ask_program_for_rib("program", command, words, data, bound);
}

/// The library is looked for as it is named, and with the ending that libraries have here.
void Reader::load_procedural(const std::string& library, const std::string& data,
                             const std::vector<float>& bound) {
    if (read_options_.procedural_host.empty())
        throw RequestError{"\"DynamicLoad\" is not supported here", {}};
    namespace fs = std::filesystem;
    std::error_code ignored;
    std::vector<std::string> words = read_options_.procedural_host;
    words.push_back(library);
    for (const std::string& folder : folders("procedural"))
        for (const char* ending : {"", ".so"}) {
            const fs::path path = fs::absolute(fs::path(folder.empty() ? "." : folder) / (library + ending));
            if (words.back() == library && fs::is_regular_file(path, ignored)) words.back() = path.string();
        }
    ask_program_for_rib("procedural", library, words, data, bound);
}

void Reader::ask_program_for_rib(const char* kind, const std::string& shown,
                                 const std::vector<std::string>& command, const std::string& data,
                                 const std::vector<float>& bound) {
    if (!takes_procedural()) return;
    if (access_.is_confined()) {
        ++summary_.unsupported[request_name_];
        warn_once("programs are not run (--safe); skipped", "programs-not-allowed");
        return;
    }
    if (!read_options_.allow_programs) {
        // A library's name is the last word, after its host's.
        std::error_code ignored;
        const bool is_there = std::string_view(kind) == "program"
                                  ? !command.empty() && has_program(command[0], folders("procedural"))
                                  : std::filesystem::is_regular_file(command.back(), ignored);
        ++summary_.unsupported[request_name_];
        if (!is_there) error("the " + std::string(kind) + " " + in_quotes(shown) + " is not found");
        warn_once("programs are run only where that is allowed (--allow-programs); skipped",
                  "programs-not-allowed");
        return;
    }
    if (!frame_wanted_) return;
    const std::string name = "<" + std::string(kind) + " " + clipped(shown) + ">";
    if (!may_read_archive(name, {})) return;
    char detail[32];
    const float area = bound.empty() ? 0 : raster_area(bound);
    const auto end = std::to_chars(detail, detail + sizeof detail, std::min(area, 1e38f)).ptr;
    Patience patience;
    patience.silence = std::chrono::milliseconds(static_cast<int64_t>(read_options_.program_seconds * 1000));
    patience.most_bytes = read_options_.max_source_bytes;
    patience.cancelled = read_options_.cancelled;
    if (read_options_.on_wait)
        patience.on_wait = [&](int seconds) {
            read_options_.on_wait("the " + std::string(kind) + " " + in_quotes(shown), seconds);
        };
    const ProgramAnswer answer =
        programs_.ask(command, std::string(detail, end) + " " + data + "\n", folders("procedural"), patience);
    if (is_stopped()) return;
    if (!answer.problem.empty())
        error("the " + std::string(kind) + " " + in_quotes(shown) + " " + answer.problem);
    if (answer.text.empty()) return;
    const uint32_t id = diagnostics_.add_source(name, at_);
    open_files_.push_back(name);
    read_in_block([&] { read_text(answer.text, {id, 1, 1}); });
    open_files_.pop_back();
}

}  // namespace trapeze::rib
