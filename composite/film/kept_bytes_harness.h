/// For tests: what a film writes of its finished tiles, and another one reads.
#pragma once

#include <cstring>
#include <string>

#include "composite/film/finished_tiles.h"

namespace trapeze::testing {

/// Bytes that are written at the end and read from the beginning.
struct KeptBytes {
    std::string text;
    size_t at = 0;  ///< the next to be read

    WriteBytes writer() {
        return [this](const void* bytes, size_t count) {
            text.append(static_cast<const char*>(bytes), count);
            return true;
        };
    }
    ReadBytes reader() {
        return [this](void* bytes, size_t count) {
            if (count > text.size() - at) return false;
            std::memcpy(bytes, text.data() + at, count);
            at += count;
            return true;
        };
    }
};

}  // namespace trapeze::testing
