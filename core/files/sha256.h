/// SHA-256 (FIPS 180-4): tells whether files have the same content, here and by the program sha256sum.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace trapeze {

/// The hash while bytes come in.
class Sha256 {
  public:
    static constexpr size_t kDigits = 64;

    void add(const void* bytes, size_t count);
    uint64_t length() const { return length_; }  ///< bytes so far
    /// The hash as hexadecimal digits. Nothing can be added afterwards.
    std::string digits();

  private:
    void mix();

    /// Of the square roots of the first eight primes.
    std::array<uint32_t, 8> hash_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                     0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<unsigned char, 64> block_;
    size_t filled_ = 0;    ///< bytes of the block
    uint64_t length_ = 0;  ///< bytes in all
};

/// The hash of some bytes as 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

/// A file's size in bytes, and the hash of its content.
struct FileHash {
    uint64_t bytes = 0;
    std::string sha256;

    bool operator==(const FileHash&) const = default;
};

/// Of a regular file; empty where there is none that can be read.
std::optional<FileHash> hash_of_file(const std::string& path);

}  // namespace trapeze
