#include "core/files/picture_files.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace trapeze {
namespace {

using namespace std::string_view_literals;

struct Beginning {
    std::string_view bytes, format;
};

/// The first bytes of the formats; TIFF and BigTIFF in both byte orders.
constexpr Beginning kBeginnings[] = {
    {"\x76\x2f\x31\x01"sv, "openexr"},
    {"II*\0"sv, "tiff"},
    {"MM\0*"sv, "tiff"},
    {"II+\0"sv, "tiff"},
    {"MM\0+"sv, "tiff"},
    {"\x89PNG\r\n\x1a\n"sv, "png"},
    {"\xff\xd8\xff"sv, "jpeg"},
    {"#?RADIANCE"sv, "hdr"},
    {"#?RGBE"sv, "hdr"},
};

/// BITMAPFILEHEADER's reserved words are 0.
bool is_bmp(std::string_view head) {
    return head.starts_with("BM") && head.size() >= 10 && head.substr(6, 4) == "\0\0\0\0"sv;
}

/// Truevision's first version has no mark: a colour map or none, one of six kinds, and 8 to 32 bits a pixel.
bool is_targa(std::string_view head, std::string_view tail) {
    if (head.size() < 18) return false;
    if (tail.ends_with("TRUEVISION-XFILE.\0"sv)) return true;
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(head[i]); };
    const bool kind = byte(2) != 0 && (byte(2) & 7) <= 3 && byte(2) <= 11;
    const bool bits = byte(16) % 8 == 0 && byte(16) >= 8 && byte(16) <= 32;
    const bool size = (byte(12) | byte(13)) != 0 && (byte(14) | byte(15)) != 0;
    return byte(1) <= 1 && kind && bits && size && byte(17) < 64;
}

}  // namespace

std::string_view picture_format(const std::string& path) {
    constexpr std::streamoff kFooter = 26;
    std::ifstream file(path, std::ios::binary);
    char bytes[18];
    file.read(bytes, sizeof bytes);
    const std::string_view head(bytes, static_cast<size_t>(file.gcount()));
    for (const Beginning& beginning : kBeginnings)
        if (head.starts_with(beginning.bytes)) return beginning.format;
    if (is_bmp(head)) return "bmp";
    char last[kFooter] = {};
    file.clear();
    file.seekg(-kFooter, std::ios::end);
    file.read(last, kFooter);
    return is_targa(head, {last, sizeof last}) ? "targa" : "";
}

bool is_baked_cloud(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    char bytes[128];
    file.read(bytes, sizeof bytes);
    const std::string_view head(bytes, static_cast<size_t>(file.gcount()));
    return head.starts_with("pptc") ||
           (head.starts_with("ply\n") && head.find(kCloudComment) != std::string_view::npos);
}

bool is_common_picture(const std::string& path) {
    constexpr std::string_view kEndings[] = {".exr", ".tif",  ".tiff", ".tx",  ".tex", ".txr",  ".ttx",
                                             ".env", ".shd",  ".sm",   ".z",   ".map", ".bump", ".png",
                                             ".jpg", ".jpeg", ".hdr",  ".tga", ".bmp"};
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    return std::find(std::begin(kEndings), std::end(kEndings), ending) != std::end(kEndings) &&
           !picture_format(path).empty();
}

}  // namespace trapeze
