/// SHA-256 (FIPS 180-4): tells whether files have the same content, here and by the program sha256sum.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace trapeze {

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
