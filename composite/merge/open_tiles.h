/// The tiles that a band of a picture's rows meets, open while rows of theirs are still to come: a grid has
/// few of them at a time, and may have more tiles than a process may have files.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <new>
#include <vector>

#include "composite/merge/merge_error.h"
#include "composite/merge/tile_headers.h"

namespace trapeze {

/// Rows, from..to, both included.
struct RowBand {
    int from = 0, to = 0;
};

/// `Input` is OpenEXR's reader of such files.
template <class Input>
class OpenTiles {
  public:
    explicit OpenTiles(const std::vector<TileFile>& files) : files_(files) {}

    /// Calls read(number of the file, reader, rows of it in the band) for each tile that the band meets, in
    /// the order of the files. Bands come from the top. What OpenEXR throws becomes a MergeError.
    template <class Read>
    void for_each_in(const RowBand& band, const Read& read) {
        for (size_t i = 0; i < files_.size(); ++i) {
            const Box2i& window = files_[i].window;
            const RowBand rows{std::max(band.from, window.min.y), std::min(band.to, window.max.y)};
            if (rows.from > rows.to) continue;
            try {
                std::unique_ptr<Input>& input = open_[i];
                if (!input) input = std::make_unique<Input>(files_[i].path.c_str(), 0);
                if (input->header().dataWindow() != window) throw std::runtime_error("it changes");
                read(i, *input, rows);
                if (rows.to == window.max.y) open_.erase(i);
            } catch (const MergeError&) {
                throw;
            } catch (const std::bad_alloc&) {
                throw;
            } catch (const std::exception& failure) {
                throw unreadable(files_[i].path, failure.what());
            }
        }
    }

  private:
    const std::vector<TileFile>& files_;
    std::map<size_t, std::unique_ptr<Input>> open_;
};

}  // namespace trapeze
