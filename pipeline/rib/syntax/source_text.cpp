#include "pipeline/rib/syntax/source_text.h"

#include <sys/stat.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include "pipeline/rib/syntax/input_file.h"
#include "pipeline/rib/syntax/zip_archive.h"

namespace trapeze::rib {
namespace {

/// Bytes that are read or inflated at once.
constexpr size_t kChunk = size_t{1} << 20;

/// A file's size is only a hint: pipes have none, and files grow while they are read. Read in pieces up to
/// the limit and one piece more, by which it is known that there is more.
std::string read_all(std::FILE* file, size_t max_bytes, std::string* problem) {
    std::string bytes;
    struct stat status {};
    if (fstat(fileno(file), &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0)
        bytes.reserve(std::min(static_cast<size_t>(status.st_size), max_bytes) + kChunk);
    size_t got = 0;
    do {
        const size_t old = bytes.size();
        bytes.resize(old + kChunk);
        got = std::fread(bytes.data() + old, 1, kChunk, file);
        bytes.resize(old + got);
        if (bytes.size() > max_bytes) {
            bytes.resize(max_bytes);
            *problem =
                "larger than the limit of " + std::to_string(max_bytes >> 20) + " MiB; the rest is not read";
            return bytes;
        }
    } while (got > 0);
    if (std::ferror(file)) *problem = std::string("read error: ") + std::strerror(errno);
    return bytes;
}

/// One character, by its code.
void append_utf8(std::string& bytes, uint32_t code) {
    if (code < 0x80) {
        bytes += static_cast<char>(code);
        return;
    }
    const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    bytes += static_cast<char>((0xff00 >> (more + 1) & 0xff) | code >> 6 * more);
    for (int i = more - 1; i >= 0; --i) bytes += static_cast<char>(0x80 | (code >> 6 * i & 0x3f));
}

/// What editors and shells of Windows write; an odd byte at the end is left out.
bool is_utf16(const std::string& text) {
    return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
}

/// Pairs of surrogates become one character; a single one is kept as it is.
std::string utf8_of_utf16(const std::string& text) {
    const bool is_big = text.starts_with("\xfe\xff");
    const auto unit_at = [&](size_t i) -> uint32_t {
        const auto first = static_cast<unsigned char>(text[i]);
        const auto second = static_cast<unsigned char>(text[i + 1]);
        return is_big ? first << 8 | second : second << 8 | first;
    };
    std::string bytes;
    bytes.reserve(text.size() / 2);
    for (size_t i = 2; i + 1 < text.size(); i += 2) {
        uint32_t code = unit_at(i);
        if (code >> 10 == 0x36 && i + 3 < text.size() && unit_at(i + 2) >> 10 == 0x37) {
            code = 0x10000 + ((code & 0x3ff) << 10) + (unit_at(i + 2) & 0x3ff);
            i += 2;
        }
        append_utf8(bytes, code);
    }
    return bytes;
}

}  // namespace

/// Memory grows with what comes out, never beyond max_bytes by more than a chunk: a small file can inflate to
/// anything.
std::string inflated(const std::string& packed, Packing packing, size_t max_bytes, std::string* problem) {
    z_stream stream{};
    std::string bytes;
    if (inflateInit2(&stream, packing == Packing::Gzip ? 15 + 32 : -15) != Z_OK) {
        *problem = "zlib does not start";
        return bytes;
    }
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    size_t left = packed.size();
    int status = Z_OK;
    while (true) {
        const uInt given = static_cast<uInt>(std::min(left, kChunk));
        stream.avail_in = given;
        const size_t old = bytes.size();
        bytes.resize(old + kChunk);
        stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + old);
        stream.avail_out = static_cast<uInt>(kChunk);
        status = inflate(&stream, Z_NO_FLUSH);
        left -= given - stream.avail_in;
        bytes.resize(old + kChunk - stream.avail_out);
        if (bytes.size() > max_bytes) {
            bytes.resize(max_bytes);
            *problem =
                "inflates to more than " + std::to_string(max_bytes >> 20) + " MiB; the rest is not read";
            break;
        }
        // gzip files may be several, one behind the other; a member of an archive is one.
        if (status == Z_STREAM_END) {
            if (left == 0 || packing == Packing::Deflate || inflateReset(&stream) != Z_OK) break;
        } else if (status != Z_OK) {
            *problem = "gzip data is damaged or cut off; read as far as it goes";
            break;
        } else if (left == 0 && stream.avail_out > 0) {
            *problem = "gzip data is cut off; read as far as it goes";
            break;
        }
    }
    inflateEnd(&stream);
    return bytes;
}

/// A file whose own name has a "!" comes before a member of an archive. Packing is undone first, the encoding
/// of the text after.
std::optional<SourceText> read_source(const std::string& path, size_t max_bytes, std::string* error,
                                      const Access& access) {
    std::error_code ignored;
    if (const auto member = zip_member_named(path); member && !std::filesystem::exists(path, ignored)) {
        auto text = read_zip_member(*member, max_bytes, error, access);
        if (!text) return {};
        return SourceText{std::move(*text), {}};
    }
    const InputFile file(path == "-" ? stdin : access.open_to_read(path));
    if (!file) {
        *error = std::strerror(errno);
        return {};
    }
    SourceText source;
    source.text = read_all(file.get(), max_bytes, &source.problem);
    if (source.text.empty() && !source.problem.empty()) {
        *error = source.problem;
        return {};
    }
    const bool gzip = source.text.size() >= 2 && source.text[0] == '\x1f' && source.text[1] == '\x8b';
    if (gzip) source.text = inflated(source.text, Packing::Gzip, max_bytes, &source.problem);
    if (is_utf16(source.text)) source.text = utf8_of_utf16(source.text);
    return source;
}

}  // namespace trapeze::rib
