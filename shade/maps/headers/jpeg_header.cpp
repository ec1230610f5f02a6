#include <set>

#include "shade/maps/headers/formats.h"

namespace trapeze {
namespace {

enum Marker : uint32_t {
    kFirstMarker = 0xff,
    kBaseline = 0xc0,
    kExtended = 0xc1,
    kHuffman = 0xc4,
    kScan = 0xda,
    kQuantization = 0xdb,
    kRestart = 0xdd,
    kApplication = 0xe0,
    kLastApplication = 0xef,
    kComment = 0xfe
};

/// Tables by class and number, as DHT and DQT have them.
using Tables = std::set<uint32_t>;

/// Reads what lies between a marker segment's length and `end`. Returns whether the tables are whole.
bool read_huffman(HeaderBytes& bytes, uint64_t end, Tables& tables) {
    while (bytes.position() < end) {
        const uint32_t table = bytes.u8();
        uint32_t values = 0, codes = 0;
        for (int length = 1; length <= 16; ++length) {
            const uint32_t count = bytes.u8();
            values += count;
            codes = codes * 2 + count;
            if (codes >= 1u << length) return false;  // too many; all ones is none
        }
        const bool is_dc = table >> 4 == 0;
        if (table >> 4 > 1 || (table & 15) > 3 || values < 1 || values > 256) return false;
        for (uint32_t i = 0; i < values; ++i)
            if (bytes.u8() > 15 && is_dc) return false;
        tables.insert(table);
    }
    return bytes.position() == end;
}

bool read_quantization(HeaderBytes& bytes, uint64_t end, Tables& tables) {
    while (bytes.position() < end) {
        const uint32_t table = bytes.u8();
        if (table > 3) return false;  // of 8 bits, as baseline has them
        for (int i = 0; i < 64; ++i)
            if (bytes.u8() == 0) return false;
        tables.insert(table);
    }
    return bytes.position() == end;
}

/// A frame of one component or three, told by number, and the quantization that each uses.
struct Frame {
    std::set<uint32_t> components, quantization;
};

std::optional<Frame> read_frame(HeaderBytes& bytes, uint64_t end) {
    const uint32_t bits = bytes.u8(), height = bytes.u16(), width = bytes.u16(), components = bytes.u8();
    if (bits != 8 || !is_plain_size(width, height) || (components != 1 && components != 3)) return {};
    Frame frame;
    for (uint32_t i = 0; i < components; ++i) {
        frame.components.insert(bytes.u8());
        const uint32_t sampling = bytes.u8();
        if ((sampling >> 4) < 1 || (sampling >> 4) > 2 || (sampling & 15) < 1 || (sampling & 15) > 2)
            return {};
        frame.quantization.insert(bytes.u8());
    }
    if (frame.components.size() != components || bytes.position() != end) return {};
    return frame;
}

/// Whether a scan holds all components of the frame, with tables that there are.
bool is_plain_scan(HeaderBytes& bytes, uint64_t end, const Frame& frame, const Tables& huffman) {
    const uint32_t components = bytes.u8();
    if (components != frame.components.size()) return false;
    std::set<uint32_t> scanned;
    for (uint32_t i = 0; i < components; ++i) {
        const uint32_t component = bytes.u8(), tables = bytes.u8();
        if (!frame.components.contains(component) || !huffman.contains(tables >> 4) ||
            !huffman.contains(0x10 | (tables & 15)))
            return false;
        scanned.insert(component);
    }
    const uint32_t first = bytes.u8(), last = bytes.u8(), approximation = bytes.u8();
    return scanned.size() == components && first == 0 && last == 63 && approximation == 0 &&
           bytes.position() == end && bytes.has(end, 2);
}

}  // namespace

std::optional<MapHeader> plain_jpeg(HeaderBytes& bytes) {
    constexpr uint64_t kStart = 2;  // of image
    bytes.seek(kStart);
    std::optional<Frame> frame;
    Tables huffman, quantization;
    while (bytes.is_good()) {
        if (bytes.u8() != kFirstMarker) return {};
        const uint32_t marker = bytes.u8();
        const uint64_t begin = bytes.position(), end = begin + bytes.u16();
        if (end < begin + 2 || !bytes.has(end, 0)) return {};
        if (marker == kScan) {
            if (!frame || !is_plain_scan(bytes, end, *frame, huffman)) return {};
            for (const uint32_t table : frame->quantization)
                if (!quantization.contains(table)) return {};
            return bytes.is_good() ? std::optional(MapHeader()) : std::nullopt;
        }
        if (marker == kHuffman) {
            if (!read_huffman(bytes, end, huffman)) return {};
        } else if (marker == kQuantization) {
            if (!read_quantization(bytes, end, quantization)) return {};
        } else if (marker == kBaseline || marker == kExtended) {
            if (frame || !(frame = read_frame(bytes, end))) return {};
        } else if (marker != kComment && marker != kRestart &&
                   !(marker >= kApplication && marker <= kLastApplication)) {
            return {};
        }
        bytes.seek(end);
    }
    return {};
}

}  // namespace trapeze
