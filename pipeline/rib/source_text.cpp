#include "pipeline/rib/source_text.h"

#include <sys/stat.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include "pipeline/rib/zip_archive.h"

namespace trapeze::rib {
namespace {

struct CloseFile {
    void operator()(std::FILE* file) const {
        if (file != stdin) std::fclose(file);
    }
};

constexpr size_t kBlock = size_t{1} << 20;

std::string read_all(std::FILE* file, size_t max_bytes, std::string* problem) {
    std::string bytes;
    struct stat status {};
    if (fstat(fileno(file), &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0)
        bytes.reserve(std::min(static_cast<size_t>(status.st_size), max_bytes) + kBlock);
    size_t got = 0;
    do {
        const size_t old = bytes.size();
        bytes.resize(old + kBlock);
        got = std::fread(bytes.data() + old, 1, kBlock, file);
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

}  // namespace

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
        const uInt given = static_cast<uInt>(std::min(left, kBlock));
        stream.avail_in = given;
        const size_t old = bytes.size();
        bytes.resize(old + kBlock);
        stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + old);
        stream.avail_out = static_cast<uInt>(kBlock);
        status = inflate(&stream, Z_NO_FLUSH);
        left -= given - stream.avail_in;
        bytes.resize(old + kBlock - stream.avail_out);
        if (bytes.size() > max_bytes) {
            bytes.resize(max_bytes);
            *problem =
                "inflates to more than " + std::to_string(max_bytes >> 20) + " MiB; the rest is not read";
            break;
        }
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

std::optional<SourceText> read_source(const std::string& path, size_t max_bytes, std::string* error) {
    std::error_code ignored;
    if (const auto member = zip_member_named(path); member && !std::filesystem::exists(path, ignored)) {
        auto text = read_zip_member(*member, max_bytes, error);
        if (!text) return {};
        return SourceText{std::move(*text), {}};
    }
    std::unique_ptr<std::FILE, CloseFile> file(path == "-" ? stdin : std::fopen(path.c_str(), "rb"));
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
    return source;
}

}  // namespace trapeze::rib
