/// A file's bytes where a header names them.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace trapeze {

/// Reads of what lies beyond the file give 0 and make is_good() false for good.
class HeaderBytes {
  public:
    explicit HeaderBytes(const std::string& path);

    bool is_good() const { return good_; }
    uint64_t size() const { return size_; }
    uint64_t position() const { return at_; }
    bool has(uint64_t offset, uint64_t bytes) const { return offset <= size_ && bytes <= size_ - offset; }
    void seek(uint64_t offset) { at_ = offset; }
    void skip(uint64_t bytes) { at_ += bytes; }

    void set_little_endian(bool is_little) { little_ = is_little; }
    uint32_t u8() { return numbers(1, 1)[0]; }
    uint32_t u16() { return numbers(2, 1)[0]; }
    uint32_t u32() { return numbers(4, 1)[0]; }
    /// The next `count` numbers of 1 to 4 bytes each, read at once.
    std::vector<uint32_t> numbers(size_t bytes_each, size_t count);
    /// The next bytes; fewer where the file ends.
    std::string text(size_t bytes);

  private:
    std::ifstream file_;
    std::string block_;  ///< bytes around what was read last
    uint64_t block_at_ = 0;
    uint64_t size_ = 0, at_ = 0;
    bool little_ = false, good_ = false;
};

}  // namespace trapeze
