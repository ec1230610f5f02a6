#include "pipeline/frame/kept_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace trapeze {
namespace {

namespace fs = std::filesystem;

/// One name for a path, however it is written; links are not followed.
std::string key_of(const std::string& path) {
    return fs::path(path).lexically_normal().string();
}

/// The first bytes of a file, which tell its format.
std::string beginning(const std::string& path) {
    char bytes[2] = {};
    std::ifstream file(path, std::ios::binary);
    file.read(bytes, sizeof bytes);
    return {bytes, static_cast<size_t>(file.gcount())};
}

/// Whether a picture may be renamed to `kept`: nothing is there, or a picture of the same format, which an
/// earlier run has left.
bool may_become(const std::string& path, const std::string& kept) {
    std::error_code failed;
    return !fs::exists(kept, failed) ||
           (fs::is_regular_file(kept, failed) && beginning(kept) == beginning(path));
}

}  // namespace

std::string numbered(const std::string& name, int number) {
    const fs::path path(name);
    const std::string file = fmt::format("{}.{}{}", path.stem().string(), number, path.extension().string());
    return (path.parent_path() / file).string();
}

void KeptPictures::make_way(const std::string& path, SourceLocation location) {
    const auto old = frames_.find(key_of(path));
    if (old == frames_.end()) return;
    const int frame = old->second;
    frames_.erase(old);
    int number = std::max(frame, 1);
    std::string kept = numbered(path, number);
    while (frames_.contains(key_of(kept)) || !may_become(path, kept)) kept = numbered(path, ++number);
    std::error_code failed;
    fs::rename(path, kept, failed);
    if (failed) {
        diagnostics_.warning(
            location, fmt::format("\"{}\" of an earlier frame is not kept: {}", path, failed.message()));
        return;
    }
    frames_[key_of(kept)] = frame;
    diagnostics_.note(location,
                      fmt::format("\"{}\" of an earlier frame is kept as \"{}\"; -o NAME.####.exr gives "
                                  "every frame a name of its own",
                                  path, kept),
                      "kept-picture");
}

void KeptPictures::wrote(const std::string& path, int frame) {
    frames_[key_of(path)] = frame;
}

void KeptPictures::forget(const std::string& path) {
    frames_.erase(key_of(path));
}

}  // namespace trapeze
