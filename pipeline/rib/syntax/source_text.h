/// The bytes of a RIB stream: a file or standard input, gzip and UTF-16 undone.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/files/access.h"

namespace trapeze::rib {

/// The whole text is in memory at once: the lexer hands out views of it. A text with a problem is used as far
/// as it goes.
struct SourceText {
    std::string text;
    std::string problem;  ///< why there is none, or not all of it; empty when all is well
};

/// Deflate is the bare stream, without gzip's header, as zip archives hold it.
enum class Packing { Gzip, Deflate };

/// Undoes gzip (several members too) or deflate, up to max_bytes. *problem stays empty when all is well.
std::string inflated(const std::string& packed, Packing packing, size_t max_bytes, std::string* problem);

/// Reads "-" as standard input, "job.zip!member" as that member of an archive. Gzip and UTF-16 are
/// known by the first two bytes. Never takes more than max_bytes, which UTF-8 may be half as much again of.
std::optional<SourceText> read_source(const std::string& path, size_t max_bytes, std::string* error,
                                      const Access& access = kEverything);

}  // namespace trapeze::rib
