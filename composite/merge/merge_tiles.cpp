#include "composite/merge/merge_tiles.h"

#include <fmt/format.h>

#include <new>

#include "composite/merge/merge_error.h"
#include "composite/merge/merge_rows.h"
#include "composite/merge/missing_tiles.h"
#include "composite/merge/tile_headers.h"
#include "core/files/output_file.h"

namespace trapeze {
namespace {

/// Pixels of a row, at most: more than any picture has, and no more than memory holds.
constexpr int64_t kMostPixelsOfRow = int64_t{1} << 20;
constexpr size_t kMostGapsNamed = 4;

MergeError unwritable(const std::string& path, const std::string& reason) {
    return {MergeOutcome::Unwritable, fmt::format("cannot write \"{}\": {}", path, reason)};
}

/// Reads all headers, and reports each file that does not go with the first.
MergeOutcome read_headers(const std::vector<std::string>& tiles, const MergeOptions& options,
                          Diagnostics& diagnostics, TileHeaders& headers) {
    MergeOutcome outcome = MergeOutcome::Written;
    for (const std::string& path : tiles) {
        if (options.is_cancelled()) return MergeOutcome::Cancelled;
        try {
            headers.add(path);
        } catch (const MergeError& problem) {
            diagnostics.error({}, problem.what());
            if (outcome != MergeOutcome::Unreadable) outcome = problem.outcome;
        }
    }
    return outcome;
}

/// What is in no tile, for a message: by the tiles' numbers where all files say which they are, and by pixels
/// where numbers do not tell. Empty: nothing is missing.
std::string missing_parts(const TileHeaders& headers) {
    std::vector<PictureTile> tiles;
    std::vector<Box2i> windows;
    for (const TileFile& file : headers.files()) {
        if (file.tile) tiles.push_back(*file.tile);
        windows.push_back(file.window);
    }
    if (tiles.size() == windows.size())
        if (const std::vector<int> missing = missing_numbers(tiles); !missing.empty())
            return fmt::format("{} {} of {}x{} {} missing", missing.size() == 1 ? "tile" : "tiles",
                               listed(missing), tiles.front().columns, tiles.front().rows,
                               missing.size() == 1 ? "is" : "are");
    const std::vector<Box2i> gaps = gaps_between(windows, kMostGapsNamed + 1);
    if (gaps.empty()) return {};
    std::string text = "these pixels are in no tile (x, y):";
    for (size_t i = 0; i < std::min(gaps.size(), kMostGapsNamed); ++i)
        text += fmt::format("{} {}..{}, {}..{}", i == 0 ? "" : ";", gaps[i].min.x, gaps[i].max.x,
                            gaps[i].min.y, gaps[i].max.y);
    return text + (gaps.size() > kMostGapsNamed ? "; and more" : "");
}

/// The window that the picture's file has. Throws where no file can have it, or tiles are missing.
void check_whole(const TileHeaders& headers, const MergeOptions& options, Diagnostics& diagnostics) {
    const Box2i window = headers.window();
    if (int64_t{window.max.x} - window.min.x >= kMostPixelsOfRow)
        throw MergeError(MergeOutcome::NoPicture,
                         fmt::format("the tiles reach from {} to {}, wider than {} pixels", window.min.x,
                                     window.max.x, kMostPixelsOfRow));
    const std::string missing = missing_parts(headers);
    if (missing.empty()) return;
    if (!options.allow_missing)
        throw MergeError(MergeOutcome::NoPicture, missing + "; --allow-missing leaves them empty");
    diagnostics.warning({}, missing + "; what they show is left empty", "missing-tiles");
}

void write(const TileHeaders& headers, const std::string& output, const MergeOptions& options,
           Diagnostics& diagnostics) {
    const Imf::Header header = headers.merged(diagnostics);
    OutputFile file(output);
    if (!file.open()) throw unwritable(output, file.error());
    try {
        (headers.is_deep() ? merge_deep_rows : merge_flat_rows)(headers, header, options, file, output);
    } catch (const MergeError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& failure) {
        throw unwritable(output, file.error().empty() ? failure.what() : file.error());
    }
    if (!file.commit()) throw unwritable(output, file.error());
}

}  // namespace

MergeOutcome merge_tiles(const std::vector<std::string>& tiles, const std::string& output,
                         const MergeOptions& options, Diagnostics& diagnostics) {
    TileHeaders headers;
    const MergeOutcome read = read_headers(tiles, options, diagnostics, headers);
    if (read != MergeOutcome::Written) return read;
    try {
        check_whole(headers, options, diagnostics);
        write(headers, output, options, diagnostics);
        return MergeOutcome::Written;
    } catch (const MergeError& problem) {
        if (problem.outcome != MergeOutcome::Cancelled) diagnostics.error({}, problem.what());
        return problem.outcome;
    }
}

}  // namespace trapeze
