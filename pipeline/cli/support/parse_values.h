/// The small languages of option values: sizes, frame lists, resolutions. Each returns nothing for what it
/// cannot read.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trapeze {

/// "512M", "2G", "1.5GiB", "1000000": bytes; K, M, G, T are powers of 1024.
std::optional<size_t> parse_size(std::string_view text);

/// "90", "90s", "1.5m", "2h": seconds, more than none.
std::optional<double> parse_duration(std::string_view text);

/// Pixels of a picture's side, at most.
inline constexpr int kMostPixelsOfSide = 65536;

/// "640x480": width and height, each from 1 to kMostPixelsOfSide.
std::optional<std::pair<int, int>> parse_resolution(std::string_view text);

/// "4x3": columns and rows of tiles, each from 1 to kMostTilesOfSide.
std::optional<std::pair<int, int>> parse_tiles(std::string_view text);

/// "8" or "8x4": samples along x and y, 1 to 64.
std::optional<std::pair<int, int>> parse_samples(std::string_view text);

/// Samples of a pixel along x and y: at most, and of adaptive sampling at least.
struct SampleRates {
    std::optional<std::pair<int, int>> least;
    std::pair<int, int> most;

    bool operator==(const SampleRates&) const = default;
};

/// "8", "8x4", or "4x4..16x16": then both sides of MIN are at least 2, and those of MAX both twice or both
/// four times as much.
std::optional<SampleRates> parse_sample_rates(std::string_view text);

/// "1x1,4x4,8": one or more of these, separated by commas, semicolons or spaces.
std::optional<std::vector<std::pair<int, int>>> parse_samples_list(std::string_view text);

/// Frames to render: ranges with an optional step, "1-10,20" or "1-9x2".
struct FrameRange {
    int first = 0, last = 0, step = 1;
    bool has(int frame) const { return frame >= first && frame <= last && (frame - first) % step == 0; }
};
std::optional<std::vector<FrameRange>> parse_frames(std::string_view text);

}  // namespace trapeze
