#include "composite/mattes/murmur_hash.h"

#include <bit>

namespace trapeze {
namespace {

constexpr uint32_t kFirstFactor = 0xcc9e2d51u, kSecondFactor = 0x1b873593u;

uint32_t scrambled(uint32_t block) {
    return std::rotl(block * kFirstFactor, 15) * kSecondFactor;
}

/// Up to four bytes as a little-endian number.
uint32_t little_endian(std::string_view bytes) {
    uint32_t number = 0;
    for (size_t i = 0; i < bytes.size(); ++i)
        number |= uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
    return number;
}

}  // namespace

uint32_t murmur_hash_3(std::string_view text) {
    uint32_t hash = 0;
    size_t at = 0;
    for (; at + 4 <= text.size(); at += 4)
        hash = std::rotl(hash ^ scrambled(little_endian(text.substr(at, 4))), 13) * 5 + 0xe6546b64u;
    if (at < text.size()) hash ^= scrambled(little_endian(text.substr(at)));
    hash ^= static_cast<uint32_t>(text.size());
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

}  // namespace trapeze
