/// For tests: what tev does with the packets that it is sent, without its window.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace trapeze::testing {

/// An image as packets have made it: 0 where nothing was put.
struct TevImage {
    int width = 0, height = 0;
    std::map<std::string, std::vector<float>> channels;
    size_t updates = 0;
};

/// Reads one packet, kind and all, without its length.
class TevPacketReader {
  public:
    explicit TevPacketReader(const std::string& bytes) : bytes_(bytes) {}

    template <class Number>
    Number number() {
        Number value{};
        if (bytes_.size() - at_ < sizeof value) throw std::runtime_error("a packet ends early");
        std::memcpy(&value, bytes_.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }
    std::string text() {
        const size_t end = bytes_.find('\0', at_);
        if (end == bytes_.npos) throw std::runtime_error("a text has no end");
        const std::string text = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        return text;
    }
    std::vector<std::string> texts() {
        std::vector<std::string> texts(static_cast<size_t>(number<int32_t>()));
        for (std::string& each : texts) each = text();
        return texts;
    }
    bool at_end() const { return at_ == bytes_.size(); }

  private:
    const std::string& bytes_;
    size_t at_ = 0;
};

/// The images that packets have made, by their names.
struct TevImages {
    std::map<std::string, TevImage> images;
    std::vector<std::string> created;  ///< names in order

    void take(const std::string& packet) {
        TevPacketReader reader(packet);
        const auto kind = reader.number<uint8_t>();
        reader.number<uint8_t>();
        const std::string name = reader.text();
        if (kind == 4) {
            TevImage image;
            image.width = reader.number<int32_t>(), image.height = reader.number<int32_t>();
            for (const std::string& channel : reader.texts())
                image.channels[channel].resize(static_cast<size_t>(image.width) *
                                               static_cast<size_t>(image.height));
            images[name] = std::move(image);
            created.push_back(name);
        } else if (kind == 5) {
            update(images.at(name), reader);
        } else {
            throw std::runtime_error("a packet of no known kind");
        }
        if (!reader.at_end()) throw std::runtime_error("a packet is too long");
    }

  private:
    static void update(TevImage& image, TevPacketReader& reader) {
        const std::vector<std::string> channels = reader.texts();
        const auto x = reader.number<int32_t>(), y = reader.number<int32_t>();
        const auto width = reader.number<int32_t>(), height = reader.number<int32_t>();
        if (x < 0 || y < 0 || width < 1 || height < 1 || x + width > image.width || y + height > image.height)
            throw std::runtime_error("pixels outside of the image");
        for (const std::string& channel : channels)
            for (int row = y; row < y + height; ++row)
                for (int column = x; column < x + width; ++column)
                    image.channels.at(channel)[static_cast<size_t>(row) * static_cast<size_t>(image.width) +
                                               static_cast<size_t>(column)] = reader.number<float>();
        ++image.updates;
    }
};

/// Listens at a port of its own for one viewer after the other, in a thread, until it is stopped.
class MockTev {
  public:
    static constexpr size_t kAll = ~size_t{0};
    /// LittleByLittle: some megabytes a second, of which it makes nothing.
    enum class Reads { Packets, LittleByLittle, Nothing };

    /// `most_packets`: after so many of the first connection it closes that, as one that was quit. `port`: 0:
    /// any that is free.
    explicit MockTev(size_t most_packets = kAll, Reads reads = Reads::Packets, int port = 0)
        : most_packets_(most_packets), reads_(reads) {
        listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET, address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        address.sin_port = htons(static_cast<uint16_t>(port));
        const int on = 1;
        setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
        socklen_t size = sizeof address;
        if (bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
            listen(listener_, 4) != 0 ||
            getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
            throw std::runtime_error("cannot listen");
        port_ = ntohs(address.sin_port);
        thread_ = std::thread([this] { serve(); });
    }
    ~MockTev() { stop(); }
    MockTev(const MockTev&) = delete;
    MockTev& operator=(const MockTev&) = delete;

    int port() const { return port_; }
    std::string address() const { return "tev:127.0.0.1:" + std::to_string(port_); }
    int connections() const { return connections_; }
    bool has_hung_up() const { return hung_up_; }

    /// What it has been sent, after the last connection was closed.
    const TevImages& stop() {
        if (listener_ >= 0) {
            done_ = true;
            if (thread_.joinable()) thread_.join();
            close(listener_);
            listener_ = -1;
        }
        EXPECT_EQ(problem_, "");
        return images_;
    }

  private:
    void serve() {
        for (;;) {
            // Those who came before the end are heard.
            const bool is_last_look = done_;
            pollfd waiting{listener_, POLLIN, 0};
            if (poll(&waiting, 1, 10) <= 0) {
                if (is_last_look) return;
                continue;
            }
            const int connection = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
            if (connection < 0) return;
            ++connections_;
            read(connection);
            close(connection);
            hung_up_ = true;
        }
    }

    void read(int connection) {
        if (reads_ == Reads::Packets) return take_packets(connection);
        std::vector<char> few(size_t{1} << 16);
        while (!done_) {
            usleep(10000);
            if (reads_ == Reads::LittleByLittle) recv(connection, few.data(), few.size(), MSG_DONTWAIT);
        }
    }

    void take_packets(int connection) {
        try {
            const size_t most = connections_ == 1 ? most_packets_ : kAll;
            for (size_t packet = 0; packet < most && take_packet(connection); ++packet) {}
        } catch (const std::exception& error) {
            problem_ = error.what();
        }
    }

    bool take_packet(int connection) {
        int32_t count = 0;
        if (!receive(connection, reinterpret_cast<char*>(&count), sizeof count)) return false;
        std::string packet(static_cast<size_t>(count) - sizeof count, '\0');
        if (!receive(connection, packet.data(), packet.size())) throw std::runtime_error("cut short");
        images_.take(packet);
        return true;
    }

    static bool receive(int connection, char* bytes, size_t count) {
        while (count > 0) {
            const ssize_t got = recv(connection, bytes, count, 0);
            if (got <= 0) return false;
            bytes += got, count -= static_cast<size_t>(got);
        }
        return true;
    }

    const size_t most_packets_;
    const Reads reads_;
    int listener_ = -1, port_ = 0;
    std::atomic<int> connections_{0};
    std::atomic<bool> done_{false}, hung_up_{false};
    TevImages images_;
    std::string problem_;
    std::thread thread_;
};

}  // namespace trapeze::testing
