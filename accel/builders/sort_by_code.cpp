#include "accel/builders/sort_by_code.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace trapeze {
namespace {

constexpr int kDigitBits = 9;  ///< as many places to write to as a cache of 32 KB has lines
constexpr size_t kDigits = size_t{1} << kDigitBits;
constexpr size_t kChunk = 1 << 16;  ///< items that one task counts and moves

using DigitCounts = std::array<uint32_t, kDigits>;

size_t digit_of(const CodedItem& item, int shift) {
    return static_cast<size_t>(item.code >> shift) & (kDigits - 1);
}

/// Turns counts of digits by chunk into where each chunk's first item of a digit goes. False: all items have
/// one digit, and stay.
bool counts_to_places(std::vector<DigitCounts>& chunks, size_t items) {
    uint32_t place = 0;
    for (size_t digit = 0; digit < kDigits; ++digit) {
        const uint32_t first = place;
        for (DigitCounts& counts : chunks) {
            const uint32_t count = counts[digit];
            counts[digit] = place;
            place += count;
        }
        if (place - first == items) return false;
    }
    return true;
}

}  // namespace

void sort_by_code(std::vector<CodedItem>& items, int bits) {
    const size_t chunk_count = (items.size() + kChunk - 1) / kChunk;
    std::vector<CodedItem> sorted(items.size());
    std::vector<DigitCounts> chunks(chunk_count);
    const auto for_chunk = [&](size_t chunk, const auto& use) {
        const size_t last = std::min(items.size(), (chunk + 1) * kChunk);
        for (size_t i = chunk * kChunk; i < last; ++i) use(items[i]);
    };
    // From the least significant digit up: each pass is stable, and so keeps what those before it have
    // sorted. Each chunk has places of its own for every digit: tasks write without asking each other, and
    // what comes out does not depend on which is first.
    for (int shift = 0; shift < bits; shift += kDigitBits) {
        tbb::parallel_for(size_t{0}, chunk_count, [&](size_t chunk) {
            chunks[chunk].fill(0);
            for_chunk(chunk, [&](const CodedItem& item) { ++chunks[chunk][digit_of(item, shift)]; });
        });
        if (!counts_to_places(chunks, items.size())) continue;
        tbb::parallel_for(size_t{0}, chunk_count, [&](size_t chunk) {
            for_chunk(chunk,
                      [&](const CodedItem& item) { sorted[chunks[chunk][digit_of(item, shift)]++] = item; });
        });
        items.swap(sorted);
    }
}

}  // namespace trapeze
