#include "shade/texture_files.h"

#include <filesystem>

#include "core/foreign_paths.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

std::optional<std::string> file_named(const std::string& name, const std::vector<std::string>& folders) {
    if (fs::path(name).is_relative())
        for (const std::string& folder : folders)
            if (const fs::path path = fs::path(folder) / name; is_file(path)) return path.string();
    return is_file(name) ? std::optional(name) : std::nullopt;
}

/// What texture makers of other renderers put at the end of the names of what they make.
constexpr const char* kMade[] = {".tx",  ".tex", ".txt", ".txr", ".ttx", ".tdl",  ".tdx",
                                 ".rat", ".env", ".cub", ".shd", ".sm",  ".tiff", ".tif"};
constexpr const char* kPictures[] = {".tif", ".tiff", ".png", ".jpg", ".jpeg", ".exr", ".tga",
                                     ".bmp", ".gif",  ".TIF", ".JPG", ".PNG",  ".hdr", ".iff"};

}  // namespace

std::optional<std::string> map_file(const std::string& name, const std::vector<std::string>& folders) {
    if (auto found = file_named(name, folders)) return found;
    for (const std::string& other : other_names(name))
        if (auto found = file_named(other, folders)) return found;
    return {};
}

std::optional<std::string> source_of_texture(const std::string& name,
                                             const std::vector<std::string>& folders) {
    for (const char* const made : kMade) {
        if (!name.ends_with(made)) continue;
        const std::string stem = name.substr(0, name.size() - std::string_view(made).size());
        if (stem.empty() || stem.back() == '/') continue;
        // picture.tif.tx
        if (fs::path(stem).has_extension())
            if (auto found = map_file(stem, folders)) return found;
        for (const char* const picture : kPictures)
            if (auto found = map_file(stem + picture, folders)) return found;
    }
    return {};
}

}  // namespace trapeze
