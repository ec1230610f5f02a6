#include "core/files/access.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <deque>
#include <filesystem>

#include "core/files/picture_files.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  ///< symbolic links that a path may lead through, as Linux allows

/// Where a path leads, after all links, those to what is not there too; empty when they go round in circles.
std::string resolved(const fs::path& path) {
    std::error_code problem;
    const fs::path whole = fs::absolute(path, problem);
    std::deque<fs::path> left(whole.begin(), whole.end());
    fs::path place;
    for (int links = 0; !left.empty();) {
        const fs::path name = left.front();
        left.pop_front();
        if (name == "..") place = place.parent_path();
        if (name.empty() || name == "." || name == "..") continue;
        const fs::path here = place / name;
        if (!fs::is_symlink(fs::symlink_status(here, problem))) {
            place = here;
            continue;
        }
        const fs::path target = fs::read_symlink(here, problem);
        if (problem || ++links > kMostLinks) return {};
        if (target.is_absolute()) place.clear();
        left.insert(left.begin(), target.begin(), target.end());
    }
    return place.string();
}

/// A folder that may be opened to scenes: not the root of all.
std::string resolved_folder(const std::string& folder) {
    const std::string path = resolved(folder.empty() ? "." : folder);
    return path == "/" ? std::string() : path;
}

/// Whether a path is a folder or in it; both resolved. Below an empty folder is nothing.
bool is_below(const std::string& path, const std::string& folder) {
    return !folder.empty() && path.starts_with(folder) &&
           (path.size() == folder.size() || path[folder.size()] == '/');
}

/// The place of a file in the folder that holds it; the file may itself be a link.
std::string place_of(const std::string& file) {
    const fs::path path(file);
    return (fs::path(resolved(path.has_parent_path() ? path.parent_path() : ".")) / path.filename()).string();
}

/// The name of what a descriptor is of; empty where the system does not tell.
std::string opened_path(int descriptor) {
    std::error_code problem;
    const fs::path path = fs::read_symlink("/proc/self/fd/" + std::to_string(descriptor), problem);
    return problem ? std::string() : path.string();
}

}  // namespace

Access Access::confined() {
    Access access;
    access.confined_ = true;
    access.working_folder_ = resolved_folder(".");
    return access;
}

void Access::allow_reading_below(const std::string& folder) {
    if (!confined_) return;
    if (std::string path = resolved_folder(folder); !path.empty()) folders_.push_back(std::move(path));
}

void Access::allow_writing(const std::string& file) {
    files_.push_back(place_of(file));
}

bool Access::may_read(const std::string& path) const {
    if (!confined_) return true;
    const std::string place = resolved(path);
    return is_below(place, working_folder_) ||
           std::any_of(folders_.begin(), folders_.end(),
                       [&](const std::string& folder) { return is_below(place, folder); });
}

bool Access::has_file(const std::string& path) const {
    std::error_code ignored;
    return may_read(path) && fs::is_regular_file(path, ignored);
}

bool Access::is_closed(const std::string& name, const std::string& folder) const {
    return !may_read((fs::path(folder) / name).string());
}

std::FILE* Access::open_to_read(const std::string& path) const {
    std::FILE* const file = confined_ ? open_confined(path) : std::fopen(path.c_str(), "rb");
    if (file) note_read(path);
    return file;
}

std::FILE* Access::open_confined(const std::string& path) const {
    if (!has_file(path)) {
        errno = may_read(path) ? ENOENT : EACCES;
        return nullptr;
    }
    // Between the two the file may have been replaced, by a pipe that nobody writes or by a link: so what has
    // been opened is asked once more.
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    if (descriptor < 0) return nullptr;
    struct stat status {};
    const std::string opened = opened_path(descriptor);
    if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && (opened.empty() || may_read(opened)))
        return ::fdopen(descriptor, "rb");
    ::close(descriptor);
    errno = EACCES;
    return nullptr;
}

bool Access::read(const std::string& path, size_t most_bytes, std::string* bytes) const {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return false;
    std::FILE* const file = open_to_read(path);
    if (!file) return false;
    bytes->clear();
    char block[1 << 16];
    for (size_t got = 1; got > 0 && bytes->size() <= most_bytes;) {
        got = std::fread(block, 1, sizeof block, file);
        bytes->append(block, got);
    }
    const bool good = std::ferror(file) == 0 && bytes->size() <= most_bytes;
    std::fclose(file);
    return good;
}

Access::Writing Access::may_write(const std::string& path) const {
    const std::string target = resolved(path);
    const bool is_named =
        std::find(files_.begin(), files_.end(), confined_ ? target : place_of(path)) != files_.end();
    Writing writing{{}, confined_ ? target : path, false};
    if (is_named) return writing;
    const bool is_here = is_below(target, confined_ ? working_folder_ : resolved("."));
    if (confined_ && !is_here) {
        writing.problem = "it lies outside of the working folder (--safe)";
        return writing;
    }
    writing.is_elsewhere = !is_here;
    std::error_code ignored;
    if (fs::is_regular_file(target, ignored) && fs::file_size(target, ignored) > 0 &&
        picture_format(target).empty() && !is_baked_cloud(target))
        writing.problem = "the file that is there is not a picture";
    return writing;
}

}  // namespace trapeze
