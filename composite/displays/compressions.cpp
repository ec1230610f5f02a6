#include "composite/displays/compressions.h"

#include <span>

namespace trapeze {
namespace {

struct Named {
    std::string_view asked, written;  ///< `written`: OpenImageIO's and OpenEXR's name of it
};

/// What each format can be compressed with.
constexpr Named kOpenExr[] = {{"none", "none"}, {"rle", "rle"},     {"zips", "zips"}, {"zip", "zip"},
                              {"piz", "piz"},   {"pxr24", "pxr24"}, {"b44", "b44"},   {"b44a", "b44a"},
                              {"dwaa", "dwaa"}, {"dwab", "dwab"}};
constexpr Named kTiff[] = {
    {"none", "none"}, {"lzw", "lzw"}, {"zip", "zip"}, {"deflate", "zip"}, {"packbits", "packbits"}};
constexpr Named kPng[] = {{"zip", "zip"}, {"deflate", "zip"}, {"none", "none"}};
constexpr Named kJpeg[] = {{"jpeg", "jpeg"}};
constexpr Named kTarga[] = {{"none", "none"}, {"rle", "rle"}};
constexpr Named kBmp[] = {{"none", "none"}};

/// A format's compressions, in the order in which messages list them.
std::span<const Named> table(FileFormat format) {
    switch (format) {
        case FileFormat::OpenExr:
            return kOpenExr;
        case FileFormat::Tiff:
            return kTiff;
        case FileFormat::Png:
            return kPng;
        case FileFormat::Jpeg:
            return kJpeg;
        case FileFormat::Targa:
            return kTarga;
        case FileFormat::Bmp:
            return kBmp;
    }
    return {};
}

}  // namespace

std::optional<std::string> compression_named(FileFormat format, std::string_view name) {
    for (const Named& row : table(format))
        if (row.asked == name) return std::string(row.written);
    return {};
}

bool holds_deep(std::string_view compression) {
    return compression == "none" || compression == "rle" || compression == "zips";
}

std::string compression_names(FileFormat format) {
    std::string names;
    for (const Named& row : table(format)) names += (names.empty() ? "" : ", ") + std::string(row.asked);
    return names;
}

}  // namespace trapeze
