/// MurmurHash3_x86_32, the hash of Cryptomatte's names (Austin Appleby's, in the public domain).
#pragma once

#include <cstdint>
#include <string_view>

namespace trapeze {

/// The hash of the bytes of a text, with seed 0.
uint32_t murmur_hash_3(std::string_view text);

}  // namespace trapeze
