#include "pipeline/preview/tev_packets.h"

#include <bit>
#include <cstdint>
#include <cstring>

namespace trapeze {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are sent as they lie in memory");

enum class Kind : uint8_t { CreateImage = 4, UpdateImage = 5 };

class Packet {
  public:
    explicit Packet(Kind kind) {
        add(int32_t{0});
        add(kind);
        add(uint8_t{0});  // whether tev is to come to the front and show this image: both kinds begin so
    }
    void add_text(std::string_view text) {
        bytes_.append(text);
        bytes_.push_back('\0');
    }
    template <class Number>
    void add(Number number) {
        bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
    }
    void add_values(std::span<const float> values) {
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    }
    std::string finish() {
        const auto count = static_cast<int32_t>(bytes_.size());
        std::memcpy(bytes_.data(), &count, sizeof count);
        return std::move(bytes_);
    }

  private:
    std::string bytes_;
};

}  // namespace

std::string tev_create_image(std::string_view name, int width, int height,
                             std::span<const std::string> channels) {
    Packet packet(Kind::CreateImage);
    packet.add_text(name);
    packet.add(static_cast<int32_t>(width));
    packet.add(static_cast<int32_t>(height));
    packet.add(static_cast<int32_t>(channels.size()));
    for (const std::string& channel : channels) packet.add_text(channel);
    return packet.finish();
}

std::string tev_update_image(std::string_view name, std::span<const std::string> channels,
                             const PixelRect& pixels, std::span<const float> values) {
    Packet packet(Kind::UpdateImage);
    packet.add_text(name);
    packet.add(static_cast<int32_t>(channels.size()));
    for (const std::string& channel : channels) packet.add_text(channel);
    for (const int number : {pixels.x0, pixels.y0, pixels.width(), pixels.height()})
        packet.add(static_cast<int32_t>(number));
    packet.add_values(values);
    return packet.finish();
}

}  // namespace trapeze
