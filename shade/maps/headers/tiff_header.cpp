#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "shade/maps/headers/formats.h"

namespace trapeze {
namespace {

enum Tag : uint32_t {
    kWidth = 256,
    kHeight = 257,
    kBits = 258,
    kCompression = 259,
    kPhotometric = 262,
    kFillOrder = 266,
    kStripOffsets = 273,
    kChannels = 277,
    kRowsPerStrip = 278,
    kStripBytes = 279,
    kPlanar = 284,
    kPredictor = 317,
    kTileWidth = 322,
    kTileHeight = 323,
    kTileOffsets = 324,
    kTileBytes = 325,
    kExtraSamples = 338,
    kSampleFormat = 339,
    kScreenFromWorld = 33305,  // Pixar's, each 16 floats
    kCameraFromWorld = 33306,
};
enum FieldType : uint32_t { kShort = 3, kLong = 4, kFloat = 11 };
constexpr uint32_t kUnsigned = 1, kFloats = 3;  // sample formats

/// A field's numbers, where they are of whole kinds; how many there are of any.
struct Field {
    uint32_t type = 0, count = 0;
    std::vector<uint32_t> numbers;
};

constexpr uint32_t kMostNumbers = 1 << 16;

class Directory {
  public:
    /// Reads the directory that begins here: fields in order of their tags, each within the file.
    bool read(HeaderBytes& bytes);
    bool has(Tag tag) const { return fields_.contains(tag); }
    /// The field's number if it has but one, or one for all channels; `otherwise` where it is not there;
    /// nothing where they differ.
    std::optional<uint32_t> number(Tag tag, uint32_t otherwise) const;
    uint32_t count(Tag tag) const { return has(tag) ? fields_.at(tag).count : 0; }
    const Field* field(Tag tag) const { return has(tag) ? &fields_.at(tag) : nullptr; }
    bool has_matrix(Tag tag) const { return count(tag) == 16 && fields_.at(tag).type == kFloat; }

  private:
    std::map<uint32_t, Field> fields_;
};

bool Directory::read(HeaderBytes& bytes) {
    constexpr std::array<uint32_t, 14> kTypeBytes = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4};
    const uint32_t fields = bytes.u16();
    uint64_t next = bytes.position();
    uint32_t before = 0;
    for (uint32_t i = 0; i < fields && bytes.is_good(); ++i) {
        bytes.seek(next);
        next += 12;
        const uint32_t tag = bytes.u16();
        Field field;
        field.type = bytes.u16(), field.count = bytes.u32();
        if (tag <= before || field.type < 1 || field.type >= kTypeBytes.size() || field.count < 1)
            return false;
        before = tag;
        const uint64_t size = uint64_t{kTypeBytes[field.type]} * field.count;
        if (size > 4) bytes.seek(bytes.u32());
        if (!bytes.has(bytes.position(), size)) return false;
        if (field.type == kShort || field.type == kLong) {
            if (field.count > kMostNumbers) return false;
            field.numbers = bytes.numbers(kTypeBytes[field.type], field.count);
        }
        fields_[tag] = std::move(field);
    }
    return bytes.is_good() && fields > 0 && bytes.has(next, 4);
}

std::optional<uint32_t> Directory::number(Tag tag, uint32_t otherwise) const {
    if (!has(tag)) return otherwise;
    const std::vector<uint32_t>& numbers = fields_.at(tag).numbers;
    if (numbers.empty()) return {};
    const bool same =
        std::all_of(numbers.begin(), numbers.end(), [&](uint32_t number) { return number == numbers[0]; });
    return same ? std::optional(numbers[0]) : std::nullopt;
}

/// Whether the pixels' parts, strips or tiles, are as many as the picture needs and lie in the file.
bool has_all_parts(const Directory& directory, const HeaderBytes& bytes, Tag offsets, Tag sizes,
                   uint64_t parts) {
    const Field* const at = directory.field(offsets);
    const Field* const lengths = directory.field(sizes);
    if (!at || !lengths || at->numbers.size() != parts || lengths->numbers.size() != parts) return false;
    for (size_t i = 0; i < parts; ++i)
        if (at->numbers[i] == 0 || lengths->numbers[i] == 0 ||
            !bytes.has(at->numbers[i], lengths->numbers[i]))
            return false;
    return true;
}

bool has_pixels(const Directory& directory, const HeaderBytes& bytes, uint32_t width, uint32_t height) {
    const auto parts_of = [](uint64_t whole, uint64_t part) { return (whole + part - 1) / part; };
    if (directory.has(kTileWidth) || directory.has(kTileHeight)) {
        const uint32_t across = directory.number(kTileWidth, 0).value_or(0);
        const uint32_t down = directory.number(kTileHeight, 0).value_or(0);
        if (across % 16 != 0 || down % 16 != 0 || !is_plain_size(across, down)) return false;
        if (directory.has(kStripOffsets) || directory.has(kStripBytes)) return false;
        return has_all_parts(directory, bytes, kTileOffsets, kTileBytes,
                             parts_of(width, across) * parts_of(height, down));
    }
    const uint32_t rows = std::min(directory.number(kRowsPerStrip, height).value_or(0), height);
    return rows > 0 && has_all_parts(directory, bytes, kStripOffsets, kStripBytes, parts_of(height, rows));
}

/// Whether what the channels beyond those of the photometric kind are is said for each, or for none.
bool has_plain_extras(const Directory& directory, uint32_t extras) {
    const Field* const field = directory.field(kExtraSamples);
    constexpr uint32_t kLastMeaning = 2;  // alpha that colours are not multiplied by
    return !field || (field->numbers.size() == extras &&
                      *std::max_element(field->numbers.begin(), field->numbers.end()) <= kLastMeaning);
}

/// Whether the numbers of a channel, and how they are packed, are such as every reader takes.
bool is_plain_format(const Directory& directory) {
    const uint32_t channels = directory.number(kChannels, 1).value_or(0);
    const uint32_t bits = directory.number(kBits, 1).value_or(0);
    const uint32_t format = directory.number(kSampleFormat, kUnsigned).value_or(0);
    const uint32_t compression = directory.number(kCompression, 1).value_or(0);
    const uint32_t photometric = directory.number(kPhotometric, 9999).value_or(9999);
    const uint32_t predictor = directory.number(kPredictor, 1).value_or(0);
    constexpr uint32_t kNone = 1, kLzw = 5, kDeflate = 8, kOldDeflate = 32946, kPackBits = 32773;
    const bool is_packed_plainly = compression == kNone || compression == kLzw || compression == kDeflate ||
                                   compression == kOldDeflate || compression == kPackBits;
    const bool is_number =
        (format == kUnsigned && (bits == 8 || bits == 16)) || (format == kFloats && bits == 32);
    const bool has_kind = (photometric == 1 && channels >= 1) || (photometric == 2 && channels >= 3);
    const bool is_predicted =
        predictor == 1 || (predictor == 2 && format == kUnsigned) || (predictor == 3 && format == kFloats);
    for (const Tag tag : {kBits, kSampleFormat})
        if (directory.has(tag) && directory.count(tag) != channels && directory.count(tag) != 1) return false;
    return is_packed_plainly && is_number && has_kind && is_predicted && channels <= 16 &&
           has_plain_extras(directory, channels - (photometric == 2 ? 3 : 1)) &&
           directory.number(kPlanar, 1) == 1u && directory.number(kFillOrder, 1) == 1u;
}

}  // namespace

std::optional<MapHeader> plain_tiff(HeaderBytes& bytes) {
    const std::string mark = bytes.text(4);
    bytes.set_little_endian(mark == std::string("II*\0", 4));
    if (mark != std::string("II*\0", 4) && mark != std::string("MM\0*", 4)) return {};
    bytes.seek(bytes.u32());
    Directory directory;
    if (!directory.read(bytes)) return {};
    const uint32_t width = directory.number(kWidth, 0).value_or(0);
    const uint32_t height = directory.number(kHeight, 0).value_or(0);
    if (!is_plain_size(width, height) || !is_plain_format(directory) ||
        !has_pixels(directory, bytes, width, height))
        return {};
    MapHeader header;
    header.is_one_float =
        directory.number(kChannels, 1) == 1u && directory.number(kSampleFormat, kUnsigned) == kFloats;
    header.has_matrices = directory.has_matrix(kScreenFromWorld) && directory.has_matrix(kCameraFromWorld);
    return header;
}

}  // namespace trapeze
