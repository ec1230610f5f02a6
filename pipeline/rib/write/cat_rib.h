/// Reads RIB and writes it again: in ASCII or binary, archives in the place of the requests that read them
/// (procedurals included), conditional blocks resolved, what cannot be read left out.
#pragma once

#include "pipeline/rib/read_rib.h"
#include "pipeline/rib/write/rib_writer.h"

namespace trapeze::rib {

/// Borrowed pointers have to live until cat_rib() returns.
struct CatOptions {
    RibEncoding encoding = RibEncoding::Ascii;
    bool gzip = false;
    bool keep_archives = false;  ///< ReadArchive stays as it is
    size_t max_source_bytes = ReadOptions{}.max_source_bytes;
    Access* access = nullptr;  ///< as ReadOptions has it
    const std::atomic<bool>* cancelled = nullptr;
};

/// `write` takes the bytes as they come. Programs of procedurals are not run: their requests are written.
ReadSummary cat_rib(std::span<const std::string> files, const CatOptions& cat, Diagnostics& diagnostics,
                    const std::function<void(std::string_view)>& write);

}  // namespace trapeze::rib
