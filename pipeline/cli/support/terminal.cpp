#include "pipeline/cli/support/terminal.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "pipeline/cli/support/json_lines.h"

namespace trapeze {
namespace {

bool stderr_is_terminal() {
    return isatty(STDERR_FILENO) == 1;
}

/// Seconds as m:ss or h:mm:ss.
std::string clock_text(double seconds) {
    const int s = static_cast<int>(seconds + 0.5);
    return s >= 3600 ? fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
                     : fmt::format("{}:{:02}", s / 60, s % 60);
}

void write(const std::string& text) {
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
}

}  // namespace

ProgressStyle progress_style(const std::string& name) {
    if (name == "bar") return ProgressStyle::Bar;
    if (name == "lines") return ProgressStyle::Lines;
    if (name == "json") return ProgressStyle::Json;
    if (name == "prman") return ProgressStyle::Prman;
    if (name == "auto" && stderr_is_terminal()) return ProgressStyle::Bar;
    return ProgressStyle::None;
}

Terminal::Terminal(const Settings& settings) : settings_(settings) {
    if (!stderr_is_terminal() || std::getenv("NO_COLOR")) settings_.color = false;
}

const char* Terminal::color_of(Severity severity) const {
    if (!settings_.color) return "";
    switch (severity) {
        case Severity::Error:
            return "\033[1;31m";
        case Severity::Warning:
            return "\033[1;35m";
        case Severity::Note:
            return "\033[1;36m";
    }
    return "";
}

void Terminal::show(const Diagnostic& diagnostic) {
    if (settings_.quiet && diagnostic.severity != Severity::Error) return;
    const std::lock_guard lock(mutex_);
    const uint64_t shown = messages_++;
    if (shown > settings_.most_messages) return;
    if (settings_.progress == ProgressStyle::Json) return write(json_line(diagnostic));
    clear_bar();
    if (shown == settings_.most_messages) return write("    there are more messages, which are not shown\n");
    const char* color = color_of(diagnostic.severity);
    write(fmt::format("{}{}{}\n", color, to_string(diagnostic), *color ? "\033[0m" : ""));
    if (active_) draw_bar();
}

void Terminal::say(const std::string& line) {
    if (settings_.quiet) return;
    const std::lock_guard lock(mutex_);
    if (settings_.progress == ProgressStyle::Json)
        return write(json_line({Severity::Note, line, {}, {}, {}}));
    clear_bar();
    write(line + "\n");
    if (active_) draw_bar();
}

void Terminal::say_on_terminal(const std::string& line) {
    if (stderr_is_terminal()) say(line);
}

void Terminal::summarise(const Diagnostics& diagnostics) {
    for (const auto& [kind, entry] : diagnostics.kinds()) {
        if (entry.count < 2) continue;
        if (settings_.quiet && entry.severity != Severity::Error) continue;
        const std::string text = fmt::format("{} times: {}", entry.count, entry.text);
        if (settings_.progress == ProgressStyle::Json)
            show({entry.severity, text, {}, {}, {}});
        else
            say("    " + text);
    }
}

void Terminal::begin_progress(const std::string& label, Work work) {
    const std::lock_guard lock(mutex_);
    label_ = label, work_ = std::move(work), fraction_ = 0, last_percent_ = -1, active_ = true;
    start_ = Clock::now();
    if (settings_.progress == ProgressStyle::Json) write_progress();
}

void Terminal::stage(std::string_view name) {
    const std::lock_guard lock(mutex_);
    if (!active_ || work_.stage == name) return;
    work_.stage = name;
    if (settings_.progress == ProgressStyle::Json) write_progress();
}

void Terminal::progress(double fraction) {
    const std::lock_guard lock(mutex_);
    if (!active_) return;
    fraction_ = fraction;
    const int percent = static_cast<int>(fraction * 100);
    if (percent == last_percent_) return;
    last_percent_ = percent;
    write_progress();
}

double Terminal::elapsed_seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Terminal::write_progress() {
    const int percent = static_cast<int>(fraction_ * 100);
    switch (settings_.progress) {
        case ProgressStyle::None:
            break;
        case ProgressStyle::Bar:
            draw_bar();
            break;
        case ProgressStyle::Lines:
            write(fmt::format("{} {}%\n", label_, percent));
            break;
        case ProgressStyle::Json:
            write(json_line(work_, fraction_, elapsed_seconds()));
            break;
        case ProgressStyle::Prman:
            write(std::getenv("TR_PROGRESS") ? fmt::format("TR_PROGRESS {:03}%\n", percent)
                                             : fmt::format("R90000 {:3}%\n", percent));
            break;
    }
}

void Terminal::end_progress() {
    const std::lock_guard lock(mutex_);
    clear_bar();
    active_ = false;
}

void Terminal::wait(const std::string& what) {
    const std::lock_guard lock(mutex_);
    switch (settings_.progress) {
        case ProgressStyle::None:
        case ProgressStyle::Prman:
            break;
        case ProgressStyle::Bar:
            write("\r" + what + "\033[K");
            bar_shown_ = true;
            break;
        case ProgressStyle::Lines:
            write(what + "\n");
            break;
        case ProgressStyle::Json:
            write(json_line(work_, fraction_, elapsed_seconds(), what));
            break;
    }
}

void Terminal::clear_bar() {
    if (!bar_shown_) return;
    write("\r\033[K");
    bar_shown_ = false;
}

void Terminal::draw_bar() {
    if (settings_.progress != ProgressStyle::Bar) return;
    winsize window{};
    const int columns =
        ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0 ? window.ws_col : 80;
    const double elapsed = elapsed_seconds();
    const double remaining = fraction_ > 0.01 ? elapsed / fraction_ - elapsed : 0;
    const std::string tail =
        fmt::format(" {:3.0f}%  {} elapsed  {} left", fraction_ * 100, clock_text(elapsed),
                    fraction_ > 0.01 ? clock_text(remaining) : "-:--");
    const int room = columns - static_cast<int>(tail.size() + label_.size()) - 4;
    std::string bar;
    if (room >= 10) {
        const int filled = static_cast<int>(fraction_ * room);
        bar = " [" + std::string(filled, '=') + std::string(room - filled, ' ') + "]";
    }
    write("\r" + label_ + bar + tail + "\033[K");
    bar_shown_ = true;
}

}  // namespace trapeze
