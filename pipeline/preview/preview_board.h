/// What all viewers of a run look at: its pictures, one after the other, and how far it is.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "core/colors/color_management.h"
#include "pipeline/preview/preview_picture.h"

namespace trapeze {

/// One picture of a run.
struct PreviewEntry {
    int number = 0;  ///< from 1
    std::shared_ptr<PreviewPicture> picture;
    std::shared_ptr<const ColorManagement> colors;  ///< null: it is to be seen by the sRGB curve
    int frame = 0;                                  ///< 0: the scene has none
};

/// How far a run is.
struct PreviewStatus {
    PreviewEntry entry;    ///< the picture that was begun last; number 0: none was
    std::string stage;     ///< of that picture, by its name in the statistics
    double fraction = 0;   ///< of it that is done
    double seconds = 0;    ///< since it began
    bool ended = false;    ///< nothing more will come of the run
    uint64_t version = 0;  ///< of all this, and of the picture's pixels
};

/// All functions are thread-safe. The run writes, viewers read.
class PreviewBoard {
  public:
    /// A viewer that is slower than the run misses pictures: so many are kept for it, or as many as fit.
    static constexpr size_t kPicturesKept = 4;
    /// So long a run waits at its end for viewers that get on slowly, where nothing else is said.
    static constexpr std::chrono::seconds kLongestEnd{20};

    /// `most_bytes`: of the pictures that are kept beside the last. A viewer has the one that it shows as
    /// well.
    explicit PreviewBoard(size_t most_bytes = ~size_t{0}, std::chrono::milliseconds longest_end = kLongestEnd)
        : most_bytes_(most_bytes), longest_end_(longest_end) {}

    void begin_picture(PreviewEntry entry);
    void begin_stage(std::string_view name);
    void progress(double fraction);
    /// The picture has new pixels, or was closed.
    void note_change();
    void end();

    PreviewStatus status() const;
    /// What is left of that; all of it until the run ends.
    std::chrono::milliseconds time_for_viewers() const;
    /// A picture that is still kept; with number 0 where it is not.
    PreviewEntry picture(int number) const;
    /// status(), once its version is greater than this, or the run has ended, or the time is over.
    PreviewStatus wait(uint64_t version, std::chrono::milliseconds at_most) const;
    /// The first picture after one of this number that is still kept, once there is one; none when the run
    /// has ended.
    PreviewEntry wait_for_picture_after(int number) const;

  private:
    PreviewStatus status_now() const;
    void forget_old_pictures();

    const size_t most_bytes_;
    const std::chrono::milliseconds longest_end_;
    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    std::deque<PreviewEntry> pictures_;
    int count_ = 0;
    PreviewStatus status_;
    std::chrono::steady_clock::time_point begun_, ended_at_;
};

}  // namespace trapeze
