#include "shade/maps/headers/header_bytes.h"

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
    std::string read(bytes, '\0');
    file_.seekg(static_cast<std::streamoff>(at_));
    file_.read(read.data(), static_cast<std::streamsize>(bytes));
    if (!file_) good_ = false;
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
