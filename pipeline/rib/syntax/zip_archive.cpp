/// Reads single members of zip archives. Nothing is kept between calls: the directory is at the archive's end
/// and is read again, which costs little beside the member.
#include "pipeline/rib/syntax/zip_archive.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>

#include "pipeline/rib/syntax/input_file.h"
#include "pipeline/rib/syntax/source_text.h"

namespace trapeze::rib {
namespace {

// PKWARE's APPNOTE.TXT, sections 4.3.7, 4.3.12 and 4.3.16.
constexpr uint32_t kLocalHeader = 0x04034b50, kCentralHeader = 0x02014b50, kEndOfDirectory = 0x06054b50;
constexpr size_t kLocalSize = 30, kCentralSize = 46, kEndSize = 22, kLongestComment = 65535;
constexpr uint64_t kLargestDirectory = uint64_t{1} << 28;
constexpr unsigned kStored = 0, kDeflated = 8;

/// Least significant byte first; the caller has checked the length.
uint32_t number(const std::string& bytes, size_t at, int count) {
    uint32_t value = 0;
    for (int i = count; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

/// Empty when there are not as many.
std::string read_at(std::FILE* file, uint64_t offset, uint64_t count) {
    std::string bytes(static_cast<size_t>(count), '\0');
    if (fseeko(file, static_cast<off_t>(offset), SEEK_SET) != 0 ||
        std::fread(bytes.data(), 1, bytes.size(), file) != bytes.size())
        return {};
    return bytes;
}

/// 0 when it cannot be told.
uint64_t size_of(std::FILE* file) {
    return fseeko(file, 0, SEEK_END) == 0 ? static_cast<uint64_t>(ftello(file)) : 0;
}

/// What the directory says of a member; its place is that of its own header, which comes before its bytes.
struct Entry {
    unsigned flags = 0, method = 0;
    uint64_t packed_size = 0, header_at = 0;
};

/// The directory's bytes, or nothing. The record that says where it is stands at the end of the file, but for
/// a comment of any length up to 65535 bytes: it is searched for backwards.
std::string read_directory(std::FILE* file) {
    const uint64_t size = size_of(file);
    const uint64_t tail_size = std::min<uint64_t>(size, kEndSize + kLongestComment);
    const std::string tail = read_at(file, size - tail_size, tail_size);
    if (tail.size() < kEndSize) return {};
    for (size_t at = tail.size() - kEndSize + 1; at-- > 0;) {
        if (number(tail, at, 4) != kEndOfDirectory) continue;
        const uint64_t length = number(tail, at + 12, 4), offset = number(tail, at + 16, 4);
        if (offset + length > size || length > kLargestDirectory) return {};
        return read_at(file, offset, length);
    }
    return {};
}

/// A damaged directory has no members from the damage on.
std::optional<Entry> find_entry(const std::string& directory, const std::string& name) {
    for (size_t at = 0; at + kCentralSize <= directory.size();) {
        if (number(directory, at, 4) != kCentralHeader) return {};
        const size_t name_length = number(directory, at + 28, 2);
        const size_t others = number(directory, at + 30, 2) + number(directory, at + 32, 2);
        if (directory.compare(at + kCentralSize, std::min(name_length, directory.size() - at - kCentralSize),
                              name) == 0)
            return Entry{number(directory, at + 8, 2), number(directory, at + 10, 2),
                         number(directory, at + 20, 4), number(directory, at + 42, 4)};
        at += kCentralSize + name_length + others;
    }
    return {};
}

/// Null, and why, where it cannot be opened.
InputFile open_archive(const std::string& path, const Access& access, std::string* error) {
    InputFile file(access.open_to_read(path));
    if (!file) *error = "the archive cannot be opened";
    return file;
}

}  // namespace

/// The last mark separates: folders of members have none.
std::optional<ZipMember> zip_member_named(const std::string& path) {
    const size_t mark = path.rfind('!');
    if (mark == std::string::npos || mark == 0 || mark + 1 == path.size()) return {};
    return ZipMember{path.substr(0, mark), path.substr(mark + 1)};
}

/// Sizes come from a stranger's file: each is compared with what there is before memory is taken.
std::optional<std::string> read_zip_member(const ZipMember& member, size_t max_bytes, std::string* error,
                                           const Access& access) {
    const InputFile file = open_archive(member.archive, access, error);
    if (!file) return {};
    const auto entry = find_entry(read_directory(file.get()), member.member);
    if (!entry) {
        *error = "the archive has no such member";
        return {};
    }
    if ((entry->flags & 1) != 0 || (entry->method != kStored && entry->method != kDeflated) ||
        entry->packed_size == UINT32_MAX || entry->packed_size > max_bytes) {
        *error = "the member is too large, encrypted or packed in an unknown way";
        return {};
    }
    // The member's own header repeats the name, and may have other extra fields than the directory.
    const std::string header = read_at(file.get(), entry->header_at, kLocalSize);
    std::string packed;
    if (!header.empty() && number(header, 0, 4) == kLocalHeader) {
        const uint64_t begin = entry->header_at + kLocalSize + number(header, 26, 2) + number(header, 28, 2);
        if (begin + entry->packed_size <= size_of(file.get()))
            packed = read_at(file.get(), begin, entry->packed_size);
    }
    if (packed.size() != entry->packed_size) {
        *error = "the archive is damaged";
        return {};
    }
    if (entry->method == kStored) return packed;
    std::string problem;
    std::string bytes = inflated(packed, Packing::Deflate, max_bytes, &problem);
    if (!problem.empty()) {
        *error = problem;
        return {};
    }
    return bytes;
}

bool has_zip_member(const ZipMember& member, const Access& access) {
    std::string ignored;
    const InputFile file = open_archive(member.archive, access, &ignored);
    return file && find_entry(read_directory(file.get()), member.member).has_value();
}

}  // namespace trapeze::rib
