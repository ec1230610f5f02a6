/// A connection that bytes are sent over as long as the other side takes them.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

struct addrinfo;

namespace trapeze {

/// Sends without ever waiting longer than it is allowed to. For one thread.
class PatientSocket {
  public:
    /// What finds the addresses of a host: getaddrinfo().
    using Lookup = int(const char* host, const char* service, const addrinfo* wanted, addrinfo** found);

    /// `patience`, asked again and again while nothing is taken, says for how long that may be; none: nothing
    /// is waited for any more. `lookup` may be called by a thread that outlives the socket.
    explicit PatientSocket(std::function<std::chrono::milliseconds()> patience);
    PatientSocket(std::function<std::chrono::milliseconds()> patience, Lookup* lookup)
        : patience_(std::move(patience)), lookup_(lookup) {}
    ~PatientSocket() { close(); }
    PatientSocket(const PatientSocket&) = delete;
    PatientSocket& operator=(const PatientSocket&) = delete;

    /// Connects by TCP. This and send() return false, with a reason in problem(), when they fail; then the
    /// socket is closed.
    bool connect(const std::string& host, int port);
    bool send(std::string_view bytes);
    /// Whether it is connected, and the other side has not hung up. It must be one that never sends anything.
    bool is_open() const;
    void close();
    const std::string& problem() const { return problem_; }

  private:
    bool try_connect(int family, const void* address, unsigned length);
    bool wait_until(const std::function<bool()>& is_so, const char* otherwise);
    bool wait_until_it_takes();
    bool fail(std::string why);

    const std::function<std::chrono::milliseconds()> patience_;
    Lookup* const lookup_;
    int file_ = -1;
    std::string problem_;
};

}  // namespace trapeze
