/// All that the program says while it works: messages and progress, on standard error, without one tearing
/// the other. With ProgressStyle::Json every line is a JSON object.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

#include "core/diagnostics.h"

namespace trapeze {

/// The forms of --progress: a bar that is drawn over, lines of percentages, lines of JSON, or lines as
/// PRMan's "R90000" ones.
enum class ProgressStyle { None, Bar, Lines, Json, Prman };

/// The style of a name. "auto" is a bar on a terminal and nothing elsewhere.
ProgressStyle progress_style(const std::string& name);

/// What is being done, as progress names it.
struct Work {
    std::string file;   ///< the picture that is made, or the scene that is read or measured
    std::string stage;  ///< as in the statistics, or what is being measured
    int frame = 0;      ///< 0: the file has none, or it is not known yet
};

/// The only writer to standard error while work goes on. All functions are thread-safe.
class Terminal {
  public:
    struct Settings {
        ProgressStyle progress = ProgressStyle::None;
        bool color = true;                      ///< if standard error is a terminal and NO_COLOR is not set
        bool quiet = false;                     ///< only errors
        uint64_t most_messages = ~uint64_t{0};  ///< that are shown
    };
    explicit Terminal(const Settings& settings);

    /// Writes a message as its severity asks; after most_messages only counts it.
    void show(const Diagnostic& diagnostic);
    void say(const std::string& line);
    /// Writes a line that nobody needs in a log: only if standard error is a terminal.
    void say_on_terminal(const std::string& line);
    /// Writes a line for each kind of message that was repeated and so not shown each time.
    void summarise(const Diagnostics& diagnostics);

    /// Begins the progress of a piece of work; `label` is what a bar or line begins with.
    void begin_progress(const std::string& label, Work work);
    /// Says which stage of the work begins, by its name in the statistics.
    void stage(std::string_view name);
    /// Says how much of the work is done, from 0 to 1.
    void progress(double fraction);
    void end_progress();
    /// Says what keeps the work waiting, between two steps of it.
    void wait(const std::string& what);

  private:
    using Clock = std::chrono::steady_clock;
    double elapsed_seconds() const;
    void write_progress();
    void clear_bar();
    void draw_bar();
    const char* color_of(Severity severity) const;

    Settings settings_;
    std::mutex mutex_;
    std::string label_;
    Work work_;
    double fraction_ = 0;
    int last_percent_ = -1;
    bool bar_shown_ = false, active_ = false;
    uint64_t messages_ = 0;
    Clock::time_point start_;
};

}  // namespace trapeze
