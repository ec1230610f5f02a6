/// Numbers in files of point clouds, byte by byte.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

namespace trapeze {

/// Appends a number's bytes, the lowest first.
template <class Number>
void put_little(std::string& bytes, Number number) {
    std::array<char, sizeof(Number)> raw;
    std::memcpy(raw.data(), &number, sizeof number);
    if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(raw);
    bytes.append(raw.data(), raw.size());
}

/// Takes numbers off the front of a text; from its end on they are 0, and ended() says so.
class ByteReader {
  public:
    explicit ByteReader(std::string_view bytes, bool big = false) : left_(bytes), big_(big) {}

    template <class Number>
    Number take() {
        std::array<char, sizeof(Number)> raw{};
        if (left_.size() < raw.size()) {
            ended_ = true, left_ = {};
            return Number{};
        }
        std::copy_n(left_.begin(), raw.size(), raw.begin());
        left_.remove_prefix(raw.size());
        if (big_ != (std::endian::native == std::endian::big)) std::ranges::reverse(raw);
        Number number;
        std::memcpy(&number, raw.data(), sizeof number);
        return number;
    }
    void skip(size_t bytes) {
        ended_ = ended_ || bytes > left_.size();
        left_.remove_prefix(std::min(bytes, left_.size()));
    }
    /// Up to the next newline, which is passed; of at most so many bytes, or nothing and ended().
    std::string_view line(size_t most) {
        const size_t end = left_.substr(0, most).find('\n');
        if (end == std::string_view::npos) {
            ended_ = true, left_ = {};
            return {};
        }
        const std::string_view line = left_.substr(0, end);
        left_.remove_prefix(end + 1);
        return line;
    }
    std::string_view left() const { return left_; }
    bool ended() const { return ended_; }

  private:
    std::string_view left_;
    bool big_, ended_ = false;
};

}  // namespace trapeze
