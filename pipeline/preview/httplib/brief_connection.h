/// A browser's connection to the server, on which nobody waits for long.
#pragma once

#include <httplib.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>

namespace trapeze {

/// The time after which nothing is waited for any more; set by one thread, read by others.
using EndOfWaiting = std::atomic<std::chrono::steady_clock::time_point>;

/// A whole request is to be said within kPatience, however few bytes come at a time, and some of an answer to
/// be taken within each kPatience, as long as the end has not come.
class BriefConnection final : public httplib::Stream {
  public:
    static constexpr std::chrono::seconds kPatience{1};

    /// Both live longer than this, which does not close the socket.
    BriefConnection(socket_t socket, const EndOfWaiting& end) : socket_(socket), end_(end) {}

    bool is_readable() const override { return at_ < filled_ || wait(POLLIN, said_by_); }
    bool is_writable() const override { return wait(POLLOUT, Clock::now() + kPatience); }

    ssize_t read(char* bytes, size_t size) override {
        while (at_ == filled_) {
            if (!is_readable()) return -1;
            const ssize_t got = recv(socket_, read_.data(), read_.size(), MSG_DONTWAIT);
            if (got < 0 && (errno == EAGAIN || errno == EINTR)) continue;
            if (got <= 0) return got;
            at_ = 0, filled_ = static_cast<size_t>(got);
        }
        const size_t count = std::min(size, filled_ - at_);
        std::copy_n(read_.data() + at_, count, bytes);
        at_ += count;
        return static_cast<ssize_t>(count);
    }
    ssize_t write(const char* bytes, size_t size) override {
        if (!is_writable()) return -1;
        const ssize_t sent = send(socket_, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
        return sent < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : sent;
    }

    /// Nobody asks: the server is this machine's own.
    void get_remote_ip_and_port(std::string& ip, int& port) const override { ip.clear(), port = 0; }
    void get_local_ip_and_port(std::string& ip, int& port) const override { ip.clear(), port = 0; }
    socket_t socket() const override { return socket_; }

  private:
    using Clock = std::chrono::steady_clock;
    /// So often the end is looked for.
    static constexpr int kLookMilliseconds = 50;

    bool wait(short events, Clock::time_point until) const {
        while (Clock::now() < std::min(until, end_.load())) {
            pollfd waiting{socket_, events, 0};
            const int ready = poll(&waiting, 1, kLookMilliseconds);
            if (ready > 0) return true;
            if (ready < 0 && errno != EINTR) return false;
        }
        return false;
    }

    const socket_t socket_;
    const EndOfWaiting& end_;
    const Clock::time_point said_by_ = Clock::now() + kPatience;
    std::array<char, 4096> read_{};
    size_t at_ = 0, filled_ = 0;
};

}  // namespace trapeze
