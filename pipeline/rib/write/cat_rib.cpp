/// The reader tells of each request as it carries it out, and this writes them down; no scene is made.
#include "pipeline/rib/write/cat_rib.h"

#include <memory>

#include "pipeline/rib/syntax/arguments.h"
#include "pipeline/rib/write/gzip_writer.h"

namespace trapeze::rib {

namespace {

/// Programs are not run by this: their requests are written as they are.
bool is_procedural(const RequestText& request) {
    return request.name == "Procedural" || request.name == "Procedural2";
}

/// Whether the request is replaced by what it reads.
bool reads_archive(const RequestText& request) {
    if (request.name == "ReadArchive") return true;
    if (!is_procedural(request) || request.arguments.empty()) return false;
    const Argument& kind = request.arguments.front();
    return kind.is_text() && kind.strings.front().starts_with("DelayedReadArchive");
}

}  // namespace

/// The answer of on_request decides: an archive's request that is not written is carried out, and what it
/// reads is written in its place; one that is written is not.
ReadSummary cat_rib(std::span<const std::string> files, const CatOptions& cat, Diagnostics& diagnostics,
                    const std::function<void(std::string_view)>& write) {
    std::unique_ptr<GzipWriter> gzip;
    if (cat.gzip) gzip = std::make_unique<GzipWriter>(write);
    RibWriter writer(cat.encoding, [&](std::string_view bytes) { gzip ? gzip->add(bytes) : write(bytes); });
    writer.comment("##RenderMan RIB-Structure 1.1");

    ReadOptions options;
    options.keep_geometry = false;
    options.max_source_bytes = cat.max_source_bytes;
    options.access = cat.access;
    options.cancelled = cat.cancelled;
    options.tells_archives = cat.keep_archives;
    options.on_request = [&](const RequestText& request) {
        const bool reads = reads_archive(request);
        if (!reads || cat.keep_archives) writer.write(request);
        return reads ? !cat.keep_archives : !is_procedural(request);
    };
    ReadSummary summary = read_rib(files, options, diagnostics, [](Scene&&) {});
    writer.flush();
    if (gzip) gzip->finish();
    return summary;
}

}  // namespace trapeze::rib
