#include "core/picture_tile.h"

#include <charconv>
#include <cstdint>
#include <filesystem>

namespace trapeze {
namespace {

/// Where the part begins that is after `index` of `count` parts of [low, high).
int border(int low, int high, int index, int count) {
    return low + static_cast<int>(int64_t{high - low} * index / count);
}

/// Takes a whole number from 1 to `most`, and `after`, from the beginning of the text.
bool take_number(std::string_view& text, int most, std::string_view after, int& number) {
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (problem != std::errc() || number < 1 || number > most) return false;
    text.remove_prefix(static_cast<size_t>(end - text.data()));
    if (!text.starts_with(after)) return false;
    text.remove_prefix(after.size());
    return true;
}

std::string digits_of(const PictureTile& tile) {
    const std::string digits = std::to_string(tile.number);
    return std::string(std::to_string(tile.count()).size() - digits.size(), '0') + digits;
}

}  // namespace

std::string name_of(const PictureTile& tile) {
    return std::to_string(tile.number) + " of " + std::to_string(tile.columns) + "x" +
           std::to_string(tile.rows);
}

std::optional<PictureTile> tile_named(std::string_view name) {
    PictureTile tile;
    const bool is_read = take_number(name, kMostTilesOfSide * kMostTilesOfSide, " of ", tile.number) &&
                         take_number(name, kMostTilesOfSide, "x", tile.columns) &&
                         take_number(name, kMostTilesOfSide, "", tile.rows);
    return is_read && name.empty() && tile.number <= tile.count() ? std::optional(tile) : std::nullopt;
}

std::string with_tile_number(const std::string& name, const PictureTile& tile) {
    constexpr std::string_view kWord = "<tile>";
    const std::string digits = digits_of(tile);
    std::string result = name;
    for (size_t at = result.find(kWord); at != std::string::npos; at = result.find(kWord, at))
        result.replace(at, kWord.size(), digits), at += digits.size();
    if (result != name) return result;
    const std::filesystem::path path(name);
    return (path.parent_path() / (path.stem().string() + ".tile" + digits + path.extension().string()))
        .string();
}

bool can_divide(const PixelRect& crop, const PictureTile& tile) {
    return tile.columns <= crop.width() && tile.rows <= crop.height();
}

PixelRect part_of(const PixelRect& crop, const PictureTile& tile) {
    const int column = (tile.number - 1) % tile.columns, row = (tile.number - 1) / tile.columns;
    return {border(crop.x0, crop.x1, column, tile.columns), border(crop.y0, crop.y1, row, tile.rows),
            border(crop.x0, crop.x1, column + 1, tile.columns), border(crop.y0, crop.y1, row + 1, tile.rows)};
}

}  // namespace trapeze
