#include "pipeline/preview/patient_socket.h"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <future>
#include <memory>
#include <system_error>
#include <thread>

namespace trapeze {
namespace {

using Clock = std::chrono::steady_clock;

/// So often the patience is asked.
constexpr std::chrono::milliseconds kAskAgain{50};

struct Addresses {
    int wrong = 0;  ///< why there are none
    std::unique_ptr<addrinfo, void (*)(addrinfo*)> first{nullptr, freeaddrinfo};
};

Addresses look_up(PatientSocket::Lookup* lookup, const std::string& host, int port, int flags) {
    addrinfo wanted{};
    wanted.ai_family = AF_UNSPEC, wanted.ai_socktype = SOCK_STREAM, wanted.ai_flags = flags;
    addrinfo* found = nullptr;
    Addresses addresses;
    addresses.wrong = lookup(host.c_str(), std::to_string(port).c_str(), &wanted, &found);
    if (!addresses.wrong) addresses.first.reset(found);
    return addresses;
}

/// The same in a thread of its own: nothing but the system's own time, half a minute and more, ends the wait
/// for a name server that is dead. Throws what std::thread does.
std::future<Addresses> look_up_aside(PatientSocket::Lookup* lookup, const std::string& host, int port) {
    std::packaged_task<Addresses()> task([=] { return look_up(lookup, host, port, 0); });
    std::future<Addresses> addresses = task.get_future();
    std::thread(std::move(task)).detach();
    return addresses;
}

}  // namespace

PatientSocket::PatientSocket(std::function<std::chrono::milliseconds()> patience)
    : PatientSocket(std::move(patience), getaddrinfo) {}

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
    Addresses addresses = look_up(lookup_, host, port, AI_NUMERICHOST);  // asks nobody
    if (addresses.wrong) try {
            std::future<Addresses> looked_up = look_up_aside(lookup_, host, port);
            if (!wait_until([&] { return looked_up.wait_for(kAskAgain) == std::future_status::ready; },
                            "nobody says where it is"))
                return false;
            addresses = looked_up.get();
        } catch (const std::system_error&) {
            return fail("there is no thread to look for it");
        }
    if (addresses.wrong) return fail(gai_strerror(addresses.wrong));
    for (const addrinfo* at = addresses.first.get(); at; at = at->ai_next)
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

/// `is_so` waits for kAskAgain.
bool PatientSocket::wait_until(const std::function<bool()>& is_so, const char* otherwise) {
    const auto since = Clock::now();
    while (Clock::now() - since < patience_())
        if (is_so()) return true;
    return fail(otherwise);
}

bool PatientSocket::wait_until_it_takes() {
    return wait_until(
        [&] {
            pollfd waiting{file_, POLLOUT, 0};
            return poll(&waiting, 1, static_cast<int>(kAskAgain.count())) > 0;
        },
        "it takes nothing any more");
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
