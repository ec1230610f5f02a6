#include "pipeline/preview/patient_socket.h"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

namespace trapeze {
namespace {

using Clock = std::chrono::steady_clock;

/// So often the patience is asked.
constexpr std::chrono::milliseconds kAskAgain{50};

}  // namespace

bool PatientSocket::fail(std::string why) {
    close();
    problem_ = std::move(why);
    return false;
}

void PatientSocket::close() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
}

bool PatientSocket::is_open() const {
    char byte = 0;
    return file_ >= 0 && recv(file_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) < 0 &&
           (errno == EAGAIN || errno == EWOULDBLOCK);
}

bool PatientSocket::connect(const std::string& host, int port) {
    close();
    addrinfo wanted{};
    wanted.ai_family = AF_UNSPEC, wanted.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (const int wrong = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found))
        return fail(gai_strerror(wrong));
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> addresses(found, freeaddrinfo);
    for (const addrinfo* at = found; at; at = at->ai_next)
        if (try_connect(at->ai_family, at->ai_addr, at->ai_addrlen)) return true;
    return false;
}

bool PatientSocket::try_connect(int family, const void* address, unsigned length) {
    file_ = socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (file_ < 0) return fail(std::strerror(errno));
    if (::connect(file_, static_cast<const sockaddr*>(address), length) == 0) return true;
    if (errno != EINPROGRESS) return fail(std::strerror(errno));
    if (!wait_until_it_takes()) return false;
    int wrong = 0;
    socklen_t size = sizeof wrong;
    getsockopt(file_, SOL_SOCKET, SO_ERROR, &wrong, &size);
    return wrong == 0 || fail(std::strerror(wrong));
}

bool PatientSocket::wait_until_it_takes() {
    const auto since = Clock::now();
    for (;;) {
        pollfd waiting{file_, POLLOUT, 0};
        if (poll(&waiting, 1, static_cast<int>(kAskAgain.count())) > 0) return true;
        if (Clock::now() - since >= patience_()) return fail("it takes nothing any more");
    }
}

bool PatientSocket::send(std::string_view bytes) {
    while (!bytes.empty()) {
        if (file_ < 0) return false;
        const ssize_t count = ::send(file_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (count >= 0)
            bytes.remove_prefix(static_cast<size_t>(count));
        else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            if (!wait_until_it_takes()) return false;
        } else if (errno != EINTR) {
            return fail(std::strerror(errno));
        }
    }
    return true;
}

}  // namespace trapeze
