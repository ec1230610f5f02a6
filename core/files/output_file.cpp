#include "core/files/output_file.h"

#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <string_view>

#include "core/files/foreign_paths.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

/// The temporary files and folders on the disk. A process has one set of them as it has one set of signal
/// handlers, for which this is kept: no render reads it.
struct Partials {
    std::mutex mutex;
    std::set<std::string> paths;
    uint64_t count = 0;
};

Partials& partials() {
    static Partials instance;
    return instance;
}

constexpr size_t kNameBytes = 200;  ///< of the target's name kept in the temporary one: names end at 255

constexpr int kMaxLinks = 40;  ///< symbolic links that are followed one after another, as Linux allows

/// Whether the path begins with a drive's letter, as on another system.
bool names_drive(const std::string& path) {
    return path.size() > 1 && path[1] == ':';
}

/// Scenes name folders that were made by hand where they come from: those below the working folder are made.
/// Others, which could be anywhere, are not. What is wrong is said when the file is written.
void make_folder_of(const std::string& path) {
    std::error_code failed;
    const fs::path whole = fs::path(path).lexically_normal();
    const fs::path here = whole.is_absolute() ? whole.lexically_relative(fs::current_path(failed)) : whole;
    const fs::path folder = here.parent_path();
    if (failed || folder.empty() || *folder.begin() == ".." || names_drive(path)) return;
    fs::create_directories(folder, failed);
}

/// Whether the folder of a file exists; no folder is the working folder.
bool has_folder(const std::string& path) {
    const fs::path folder = fs::path(path).parent_path();
    std::error_code failed;
    return names_drive(path) ? fs::exists(folder, failed) && !folder.empty()
                             : folder.empty() || fs::exists(folder, failed);
}

}  // namespace

OutputFile::~OutputFile() {
    if (file_) std::fclose(file_);
    if (partial_.empty()) return;
    ::unlink(partial_.c_str());
    const std::lock_guard lock(partials().mutex);
    partials().paths.erase(partial_);
}

bool OutputFile::fail(std::string reason) {
    if (error_.empty()) error_ = std::move(reason);
    return false;
}

bool OutputFile::fail_with_errno() {
    return fail(std::strerror(errno));
}

/// The folder and name to write, after links; false if something that is not a file of ours to replace is
/// there.
bool OutputFile::find_place(std::string& folder, std::string& name) {
    std::error_code failed;
    fs::path path(target_);
    // A link stays a link: what it points to is replaced, or made.
    for (int links = 0; links < kMaxLinks && fs::is_symlink(fs::symlink_status(path, failed)); ++links) {
        path = path.parent_path() / fs::read_symlink(path, failed);
        if (failed) return fail(failed.message());
    }
    target_ = path.string();
    name = path.filename().string();
    folder = path.parent_path().string();
    if (name.empty()) return fail("it names no file");
    if (!folder.empty() && !fs::is_directory(folder, failed))
        return fail("there is no folder \"" + folder + "\"");
    const fs::file_status status = fs::status(path, failed);
    if (!fs::exists(status)) return true;
    if (fs::is_directory(status)) return fail("it is a folder");
    if (!fs::is_regular_file(status)) return fail("it is not a regular file");
    return ::access(target_.c_str(), W_OK) == 0 || fail_with_errno();
}

/// The name is noted before the file is there, and the lock is not held while it is made: disks may let a
/// call wait for as long as they like, and a process that is to end may not wait for them.
bool OutputFile::open() {
    std::string folder, partial;
    if (!find_place(folder, partial)) return false;
    if (!folder.empty() && folder.back() != '/') folder += '/';
    {
        const std::lock_guard lock(partials().mutex);
        partial = folder + partial.substr(0, kNameBytes) + "." + std::to_string(::getpid()) + ".part-" +
                  std::to_string(++partials().count);
        partials().paths.insert(partial);
    }
    file_ = std::fopen(partial.c_str(), "wbxe");
    if (!file_ && errno == EEXIST) {
        // It was left by a process of the same number, which was killed.
        ::unlink(partial.c_str());
        file_ = std::fopen(partial.c_str(), "wbxe");
    }
    if (!file_) fail_with_errno();
    if (file_) static_cast<void>(::flock(::fileno(file_), LOCK_EX | LOCK_NB));  // for remove_leftovers()
    const std::lock_guard lock(partials().mutex);
    if (file_ && partials().paths.contains(partial)) {
        partial_ = partial;
        return true;
    }
    partials().paths.erase(partial);
    if (!file_) return false;
    std::fclose(file_);  // remove_partials() came before the file
    file_ = nullptr;
    ::unlink(partial.c_str());
    return fail("the process is about to end");
}

bool OutputFile::write(const void* bytes, size_t count) {
    if (!error_.empty()) return false;
    if (!file_) return fail("it is not open");
    if (std::fwrite(bytes, 1, count, file_) != count) return fail_with_errno();
    position_ += count;
    return true;
}

bool OutputFile::seek(uint64_t position) {
    if (!error_.empty()) return false;
    if (!file_) return fail("it is not open");
    if (::fseeko(file_, static_cast<off_t>(position), SEEK_SET) != 0) return fail_with_errno();
    position_ = position;
    return true;
}

bool OutputFile::commit() {
    if (!error_.empty()) return false;
    if (!file_) return fail("it is not open");
    if (std::fflush(file_) != 0) return fail_with_errno();
    // Some file systems know no fsync; a full disk may be noticed only here.
    if (::fsync(::fileno(file_)) != 0 && errno != EINVAL && errno != ENOTSUP) return fail_with_errno();
    const bool closed = std::fclose(file_) == 0;
    file_ = nullptr;
    if (!closed) return fail_with_errno();
    if (::rename(partial_.c_str(), target_.c_str()) != 0) return fail_with_errno();
    const std::lock_guard lock(partials().mutex);
    partials().paths.erase(partial_);
    partial_.clear();
    return true;
}

void OutputFile::remove_partials() {
    const std::lock_guard lock(partials().mutex);
    // Without allocations: memory may have run out. What is in a folder comes behind it in the set.
    for (auto path = partials().paths.rbegin(); path != partials().paths.rend(); ++path)
        std::remove(path->c_str());
    partials().paths.clear();
}

void OutputFile::remove_leftovers(const std::string& target) {
    const fs::path path(target);
    const std::string beginning = path.filename().string().substr(0, kNameBytes) + ".";
    std::error_code failed;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(beginning)) continue;
        const std::string_view rest = std::string_view(name).substr(beginning.size());
        const size_t digits = rest.find_first_not_of("0123456789");
        if (digits == 0 || digits == rest.npos || !rest.substr(digits).starts_with(".part-")) continue;
        std::FILE* const file = std::fopen(entry.path().c_str(), "rbe");
        if (!file) continue;
        if (::flock(::fileno(file), LOCK_EX | LOCK_NB) == 0) fs::remove(entry.path(), failed);
        std::fclose(file);
    }
}

void OutputFile::remove_at_the_end(const std::string& path) {
    const std::lock_guard lock(partials().mutex);
    partials().paths.insert(path);
}

void OutputFile::remove(const std::string& path) {
    const std::lock_guard lock(partials().mutex);
    std::remove(path.c_str());
    partials().paths.erase(path);
}

OutputPlace place_to_write(const std::string& name, const Access& access, SourceLocation asked_at,
                           Diagnostics& diagnostics) {
    OutputPlace place{name, name, access.may_write(name).problem};
    if (!place.problem.empty() && has_folder(name)) return place;
    if (place.problem.empty()) make_folder_of(access.may_write(name).path);
    if (!has_folder(name)) {
        const std::vector<std::string> others = other_names(name);
        if (!others.empty()) place.name = others.back();
    }
    const Access::Writing writing = access.may_write(place.name);
    place.path = writing.path, place.problem = writing.problem;
    if (place.name != name)
        diagnostics.warning(
            asked_at, "there is no folder for \"" + name + "\"; it is written as \"" + place.name + "\"",
            "no-folder");
    else if (writing.is_elsewhere && place.problem.empty())
        diagnostics.note(asked_at, "\"" + name + "\" lies outside of the working folder",
                         "written-elsewhere");
    return place;
}

}  // namespace trapeze
