/// Scenes move between machines and folders, and name their files as it was at home. All guesses are made
/// here; each that finds something is a warning, so that nobody wonders which file was read.
#include "pipeline/rib/reader/file_search.h"

#include <filesystem>

#include "core/files/foreign_paths.h"
#include "pipeline/rib/syntax/arguments.h"
#include "pipeline/rib/syntax/search_path.h"
#include "pipeline/rib/syntax/zip_archive.h"

namespace trapeze::rib {
namespace {

namespace fs = std::filesystem;

/// A file, or a member of a zip archive.
bool is_readable(const std::string& path, const Access& access) {
    if (access.has_file(path)) return true;
    const auto member = zip_member_named(path);
    return member && has_zip_member(*member, access);
}

}  // namespace

/// Texts that are no files (answers, inline archives) count as part of the file around them.
std::string OpenFiles::current_file() const {
    for (size_t i = names_.size(); i-- > 0;)
        if (names_[i] != "-" && names_[i][0] != '<') return names_[i];
    return {};
}

std::string OpenFiles::current_folder() const {
    return fs::path(current_file()).parent_path().string();
}

/// Folders that are closed to the scene are left out with a warning; files in them would not be readable
/// anyway, but their user shall know.
void FileSearch::set_search_path(const std::string& category, const std::string& path) {
    std::vector<std::string>& folders = state_.options().search_paths[category];
    // What the user's own text reads is no longer that text.
    const bool is_users = is_trusted_ && files_.depth() == 1;
    std::vector<std::string> closed;
    folders =
        expand_search_path(path, folders, files_.current_folder(), is_users ? kEverything : access_, &closed);
    if (is_users)
        for (const std::string& folder : folders) access_.allow_reading_below(folder);
    for (const std::string& folder : closed)
        report_.warn_once("the folder " + in_quotes(folder) + " " + Access::kClosed + "; not searched",
                          "closed-folder " + folder);
}

/// The search path comes first: who wrote it meant it. Folders that are not there stay in the list: who looks
/// for a file passes them by.
std::vector<std::string> FileSearch::folders(const std::string& category) const {
    const auto& paths = state_.options().search_paths;
    const auto path = paths.find(category);
    std::vector<std::string> all;
    if (path != paths.end()) all = path->second;
    const std::string current = files_.current_folder();
    const std::string folder = current.empty() ? "." : current;
    all.insert(all.end(), {folder, ""});
    // Projects keep their scenes in a folder of their own, and name files from the one above.
    all.insert(all.end(), {folder + "/..", folder + "/../.."});
    const std::vector<std::string> usual = usual_folders(category, folder, access_);
    all.insert(all.end(), usual.begin(), usual.end());
    return all;
}

/// Guesses go from the likely to the far-fetched, and the first that can be read ends the search: a name as
/// it stands, then without leading folders, then from the folders above, then in the folders that exporters
/// use.
std::optional<std::string> FileSearch::find_archive(const std::string& name) {
    if (const auto found = find_archive_named(name)) return found;
    const auto instead = [&](const std::string& found) {
        report_.warn_once(in_quotes(name) + " is not found; " + in_quotes(found) + " is read",
                          "archive-elsewhere " + name);
        return found;
    };
    for (const std::string& other : other_names(name))
        if (const auto found = find_archive_named(other)) return instead(*found);
    // Exporters name files from their project's folder, and write those that name them below it.
    std::vector<std::string> names = other_names(name);
    names.insert(names.begin(), name);
    fs::path above = fs::path(files_.current_folder());
    for (int level = 0; level < kMostFoldersAbove; ++level) {
        above /= "..";
        for (const std::string& other : names) {
            const std::string candidate = (above / other).string();
            if (fs::path(other).is_relative() && other.find('/') != std::string::npos &&
                is_readable(candidate, access_))
                return instead(candidate);
        }
    }
    for (const std::string& folder : usual_folders("archive", files_.current_folder(), access_))
        for (const std::string& other : names)
            if (const std::string candidate = (fs::path(folder) / other).string();
                is_readable(candidate, access_))
                return instead(candidate);
    return {};
}

/// A pipe counts where it is named whole: nobody looks for one.
std::optional<std::string> FileSearch::find_archive_named(const std::string& name) const {
    std::error_code ignored;
    const fs::path path(name);
    if (path.is_absolute())
        return is_readable(name, access_) || (!access_.is_confined() && fs::is_fifo(path, ignored))
                   ? std::optional(name)
                   : std::nullopt;
    std::vector<std::string> folders{files_.current_folder()};
    const auto& all_paths = state_.options().search_paths;
    if (const auto paths = all_paths.find("archive"); paths != all_paths.end())
        folders.insert(folders.end(), paths->second.begin(), paths->second.end());
    folders.push_back("");
    for (const std::string& folder : folders)
        if (const fs::path candidate = fs::path(folder) / path; is_readable(candidate.string(), access_))
            return candidate == "-" ? "./-" : candidate.string();  // a file of that name is not the input
    return {};
}

}  // namespace trapeze::rib
