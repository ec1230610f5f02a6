#include "pipeline/checkpoint/checkpoint_file.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/files/output_file.h"
#include "core/files/sha256.h"
#include "pipeline/frame/json_text.h"

namespace trapeze {
namespace {

using json = nlohmann::ordered_json;

constexpr std::string_view kFirstLine = "Trapeze checkpoint 1\n";
constexpr uint64_t kMostStateBytes = uint64_t{1} << 28;  ///< a JSON of more is none of ours

json to_json(const std::vector<SeenFile>& files) {
    json all = json::array();
    for (const SeenFile& file : files)
        all.push_back({{"name", file.name},
                       {"bytes", file.bytes},
                       {"sha256", file.sha256},
                       {"modified", file.modified}});
    return all;
}

std::vector<SeenFile> files_from(const json& all) {
    std::vector<SeenFile> files;
    for (const json& file : all)
        files.push_back({file.at("name"), file.at("bytes"), file.at("sha256"), file.at("modified")});
    return files;
}

json to_json(const FinishedWorld& world) {
    return {
        {"failed", world.failed}, {"shows_something", world.shows_something}, {"pictures", world.pictures}};
}

FinishedWorld world_from(const json& from) {
    return {from.at("failed"), from.at("shows_something"), from.at("pictures")};
}

json to_json(const CheckpointState& state) {
    json options = json::array(), worlds = json::array();
    for (const RecordedOption& option : state.origin.options)
        options.push_back({{"name", option.name}, {"values", option.values}});
    for (const FinishedWorld& world : state.worlds) worlds.push_back(to_json(world));
    return {{"version", state.origin.version},
            {"revision", state.origin.revision},
            {"options", std::move(options)},
            {"files", to_json(state.origin.files)},
            {"worlds", std::move(worlds)},
            {"maps", state.maps},
            {"map_files", state.map_files},
            {"passes", state.passes},
            {"kept", state.kept},
            {"written", to_json(state.written)},
            {"tiles", state.tiles},
            {"regions", state.regions}};
}

/// Throws what nlohmann's library throws where something is missing, or of another kind.
CheckpointState state_from(const json& from) {
    CheckpointState state;
    state.origin = {from.at("version"), from.at("revision"), {}, files_from(from.at("files"))};
    for (const json& option : from.at("options"))
        state.origin.options.push_back({option.at("name"), option.at("values")});
    for (const json& world : from.at("worlds")) state.worlds.push_back(world_from(world));
    from.at("maps").get_to(state.maps);
    from.at("map_files").get_to(state.map_files);
    from.at("passes").get_to(state.passes);
    from.at("kept").get_to(state.kept);
    state.written = files_from(from.at("written"));
    from.at("tiles").get_to(state.tiles);
    from.at("regions").get_to(state.regions);
    return state;
}

/// The bytes of an open file that come before its hash, if that is theirs; the file is then at its beginning.
std::optional<uint64_t> bytes_before_hash(std::FILE* file) {
    if (std::fseek(file, 0, SEEK_END) != 0) return {};
    const long size = std::ftell(file);
    if (size < static_cast<long>(kFirstLine.size() + Sha256::kDigits)) return {};
    std::rewind(file);
    const auto before = static_cast<uint64_t>(size) - Sha256::kDigits;
    Sha256 hash;
    std::vector<char> block(1 << 16);
    for (uint64_t at = 0; at < before;) {
        const size_t count = std::min<uint64_t>(block.size(), before - at);
        if (std::fread(block.data(), 1, count, file) != count) return {};
        hash.add(block.data(), count);
        at += count;
    }
    std::string digits(Sha256::kDigits, '\0');
    if (std::fread(digits.data(), 1, digits.size(), file) != digits.size() || digits != hash.digits())
        return {};
    std::rewind(file);
    return before;
}

}  // namespace

std::string write_checkpoint(const std::string& path, const CheckpointState& state,
                             const std::function<bool(const WriteBytes&)>& write_tiles) {
    OutputFile file(path);
    Sha256 hash;
    const WriteBytes write = [&](const void* bytes, size_t count) {
        hash.add(bytes, count);
        return file.write(bytes, count);
    };
    const std::string text = json_text(to_json(state), -1);
    const uint64_t length = text.size();
    bool good = file.open() && write(kFirstLine.data(), kFirstLine.size()) && write(&length, sizeof length) &&
                write(text.data(), text.size()) && write_tiles(write);
    if (good) {
        const std::string digits = hash.digits();
        good = file.write(digits.data(), digits.size()) && file.commit();
    }
    if (good) return {};
    return file.error().empty() ? "it was not finished" : file.error();
}

bool is_checkpoint(const std::string& path) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    std::string line(kFirstLine.size(), '\0');
    return file && std::fread(line.data(), 1, line.size(), file.get()) == line.size() && line == kFirstLine;
}

std::unique_ptr<CheckpointReader> CheckpointReader::open(const std::string& path, std::string* problem) {
    auto reader = std::make_unique<CheckpointReader>();
    reader->file_.reset(std::fopen(path.c_str(), "rb"));
    if (!reader->file_) {
        *problem = std::strerror(errno);
        return {};
    }
    *problem = "it is damaged, or was cut short";
    const auto bytes = bytes_before_hash(reader->file_.get());
    if (!bytes) return {};
    reader->left_ = *bytes;
    std::string line(kFirstLine.size(), '\0');
    uint64_t length = 0;
    if (!reader->read(line.data(), line.size()) || line != kFirstLine ||
        !reader->read(&length, sizeof length) || length > std::min(reader->left_, kMostStateBytes))
        return {};
    std::string text(length, '\0');
    if (!reader->read(text.data(), length)) return {};
    try {
        reader->state_ = state_from(json::parse(text));
    } catch (const json::exception&) {
        return {};
    }
    problem->clear();
    return reader;
}

bool CheckpointReader::read(void* bytes, size_t count) {
    if (count > left_ || std::fread(bytes, 1, count, file_.get()) != count) return false;
    left_ -= count;
    return true;
}

}  // namespace trapeze
