#include "pipeline/rib/write/gzip_writer.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <new>

namespace trapeze::rib {

/// zlib's stream, kept out of the header: few files know zlib.
struct GzipWriter::State {
    z_stream stream{};
    std::array<char, 1 << 16> out;
};

GzipWriter::GzipWriter(std::function<void(std::string_view)> write)
    : write_(std::move(write)), state_(std::make_unique<State>()) {
    constexpr int kGzip = 15 + 16;  // the largest window, in gzip's wrapping
    if (deflateInit2(&state_->stream, 6, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::bad_alloc();
}

GzipWriter::~GzipWriter() {
    deflateEnd(&state_->stream);
}

/// Until zlib has no more to give: with Z_NO_FLUSH it keeps some of the input for later.
void GzipWriter::deflate_all(int flush) {
    z_stream& stream = state_->stream;
    do {
        stream.next_out = reinterpret_cast<Bytef*>(state_->out.data());
        stream.avail_out = static_cast<uInt>(state_->out.size());
        deflate(&stream, flush);
        write_({state_->out.data(), state_->out.size() - stream.avail_out});
    } while (stream.avail_out == 0);
}

/// zlib counts in 32 bits: longer pieces are cut.
void GzipWriter::add(std::string_view bytes) {
    while (!bytes.empty()) {
        const size_t part = std::min<size_t>(bytes.size(), std::numeric_limits<uInt>::max());
        state_->stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
        state_->stream.avail_in = static_cast<uInt>(part);
        deflate_all(Z_NO_FLUSH);
        bytes.remove_prefix(part);
    }
}

/// Writes what zlib has kept, and gzip's checksum and length.
void GzipWriter::finish() {
    state_->stream.next_in = nullptr;
    state_->stream.avail_in = 0;
    deflate_all(Z_FINISH);
}

}  // namespace trapeze::rib
