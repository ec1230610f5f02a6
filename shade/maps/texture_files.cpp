#include "shade/maps/texture_files.h"

#include <filesystem>

#include "core/files/foreign_paths.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> file_named(const std::string& name, const std::vector<std::string>& folders,
                                      const Access& access) {
    if (fs::path(name).is_relative())
        for (const std::string& folder : folders)
            if (const std::string path = (fs::path(folder) / name).string(); access.has_file(path))
                return path;
    return access.has_file(name) ? std::optional(name) : std::nullopt;
}

/// Endings that texture makers of other renderers add to, or put for, the ending of a picture's name.
constexpr const char* kMade[] = {".tx",  ".tex", ".txt", ".txr", ".ttx", ".tdl",  ".tdx",
                                 ".rat", ".env", ".cub", ".shd", ".sm",  ".tiff", ".tif"};
constexpr const char* kPictures[] = {".tif", ".tiff", ".png", ".jpg", ".jpeg", ".exr", ".tga",
                                     ".bmp", ".gif",  ".TIF", ".JPG", ".PNG",  ".hdr", ".iff"};

}  // namespace

std::optional<std::string> map_file(const std::string& name, const std::vector<std::string>& folders,
                                    const Access& access) {
    if (auto found = file_named(name, folders, access)) return found;
    for (const std::string& other : other_names(name))
        if (auto found = file_named(other, folders, access)) return found;
    return {};
}

std::optional<std::string> source_of_texture(const std::string& name, const std::vector<std::string>& folders,
                                             const Access& access) {
    for (const char* const made : kMade) {
        if (!name.ends_with(made)) continue;
        const std::string stem = name.substr(0, name.size() - std::string_view(made).size());
        if (stem.empty() || stem.back() == '/') continue;
        // A texture may be named by adding an ending: picture.tif.tx.
        if (fs::path(stem).has_extension())
            if (auto found = map_file(stem, folders, access)) return found;
        for (const char* const picture : kPictures)
            if (auto found = map_file(stem + picture, folders, access)) return found;
    }
    return {};
}

}  // namespace trapeze
