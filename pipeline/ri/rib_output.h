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

/// The form of RIB files, as Option "rib" sets it before RiBegin.
struct RibFormat {
    bool binary = false, gzip = false;
};

/// The RIB of one context.
class RibOutput {
  public:
    /// Writes into the file `name`, or into memory for an empty name.
    RibOutput(const std::string& name, RibFormat format);

    rib::RibWriter& writer() { return *writer_; }
    bool is_file() const { return file_.has_value(); }
    /// What has been written into memory so far.
    const std::string& text();
    /// Puts the file in its place; false when that, or anything before, has failed.
    bool commit();
    /// Why the output failed; empty if it did not.
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
