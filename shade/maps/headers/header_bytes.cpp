#include "shade/maps/headers/header_bytes.h"

#include <algorithm>

namespace trapeze {

HeaderBytes::HeaderBytes(const std::string& path) : file_(path, std::ios::binary | std::ios::ate) {
    const std::streamoff size = file_ ? static_cast<std::streamoff>(file_.tellg()) : -1;
    good_ = size > 0;
    if (good_) size_ = static_cast<uint64_t>(size);
}

std::string HeaderBytes::text(size_t bytes) {
    if (!has(at_, bytes)) {
        good_ = false;
        return {};
    }
    constexpr uint64_t kBlock = 4096;
    if (at_ < block_at_ || at_ + bytes > block_at_ + block_.size()) {
        block_at_ = at_;
        block_.assign(std::min(std::max(uint64_t{bytes}, kBlock), size_ - at_), '\0');
        file_.seekg(static_cast<std::streamoff>(at_));
        file_.read(block_.data(), static_cast<std::streamsize>(block_.size()));
        if (!file_) good_ = false;
    }
    const std::string read = block_.substr(at_ - block_at_, bytes);
    at_ += bytes;
    return read;
}

std::vector<uint32_t> HeaderBytes::numbers(size_t bytes_each, size_t count) {
    const std::string read = text(bytes_each * count);
    std::vector<uint32_t> numbers(count, 0);
    for (size_t i = 0; i < read.size(); ++i) {
        const size_t at = i % bytes_each, from_top = little_ ? bytes_each - 1 - at : at;
        const size_t first = i - at;
        numbers[i / bytes_each] =
            numbers[i / bytes_each] << 8 | static_cast<unsigned char>(read[first + from_top]);
    }
    return numbers;
}

}  // namespace trapeze
