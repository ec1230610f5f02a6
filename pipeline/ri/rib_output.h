/// Where a context's RIB goes: into memory, or into a file that appears whole or not at all.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/files/output_file.h"
#include "pipeline/rib/write/gzip_writer.h"
#include "pipeline/rib/write/rib_writer.h"

namespace trapeze::ri {

/// What Option "rib" says of the files to come.
struct RibFormat {
    bool binary = false, gzip = false;
};

class RibOutput {
  public:
    /// An empty name: memory.
    RibOutput(const std::string& name, RibFormat format);

    rib::RibWriter& writer() { return *writer_; }
    bool is_file() const { return file_.has_value(); }
    /// What is in memory.
    const std::string& text();
    /// Puts the file in its place; false when that, or anything before, has failed.
    bool commit();
    /// Why it failed; empty if it did not.
    const std::string& error() const;

  private:
    void write(std::string_view bytes);

    std::string text_;
    std::optional<OutputFile> file_;
    bool good_ = true;
    std::optional<rib::GzipWriter> gzip_;
    std::unique_ptr<rib::RibWriter> writer_;  ///< the last: it flushes into the others when it goes
};

}  // namespace trapeze::ri
