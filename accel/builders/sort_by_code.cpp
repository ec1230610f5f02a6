#include "accel/builders/sort_by_code.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <span>

namespace trapeze {
namespace {

constexpr int kDigitBits = 9;  ///< as many places to write to as a cache of 32 KB has lines
constexpr size_t kDigits = size_t{1} << kDigitBits;
constexpr size_t kChunk = 1 << 16;    ///< items that one task counts and moves
constexpr size_t kCompareUpTo = 128;  ///< items that are sorted faster by comparing them

using DigitCounts = std::array<uint32_t, kDigits>;

size_t digit_of(const CodedItem& item, int shift) {
    return static_cast<size_t>(item.code >> shift) & (kDigits - 1);
}

/// Turns counts of digits by chunk into where each chunk's first item of a digit goes. False: all items have
/// one digit, and stay.
bool counts_to_places(std::span<DigitCounts> chunks, size_t items) {
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

/// Sorts a few items. `stays`: what comes out is where they are, else in `other`, which is as large.
void sort_few(std::span<CodedItem> items, std::span<CodedItem> other, bool stays) {
    // They come in order, so that those of one code stay in it.
    std::ranges::sort(items, [](const CodedItem& a, const CodedItem& b) {
        return a.code != b.code ? a.code < b.code : a.item < b.item;
    });
    if (!stays) std::ranges::copy(items, other.begin());
}

/// Sorts what fits caches on one thread, from the least significant digit up: each pass is stable, and so
/// keeps what those before it have sorted. `stays`: as above.
void sort_part(std::span<CodedItem> items, std::span<CodedItem> other, int bits, bool stays) {
    if (items.size() <= kCompareUpTo) return sort_few(items, other, stays);
    std::span<CodedItem> from = items, to = other;
    DigitCounts places;
    for (int shift = 0; shift < bits; shift += kDigitBits) {
        places.fill(0);
        for (const CodedItem& item : from) ++places[digit_of(item, shift)];
        if (!counts_to_places(std::span(&places, 1), items.size())) continue;
        for (const CodedItem& item : from) to[places[digit_of(item, shift)]++] = item;
        std::swap(from, to);
    }
    if ((from.data() == items.data()) != stays) std::ranges::copy(from, to.begin());
}

/// Parts many items by their most significant digit, so that caches hold what is to be sorted by the others.
/// Each chunk of them has places of its own for every digit: tasks write without asking each other, and what
/// comes out does not depend on which is first. `stays`: as above.
void sort_many(std::span<CodedItem> items, std::span<CodedItem> other, int bits, bool stays) {
    if (items.size() <= kChunk || bits <= kDigitBits) return sort_part(items, other, bits, stays);
    const int shift = bits - kDigitBits;
    std::vector<DigitCounts> chunks((items.size() + kChunk - 1) / kChunk);
    const auto for_chunks = [&](const auto& use) {
        tbb::parallel_for(size_t{0}, chunks.size(), [&](size_t chunk) {
            const size_t first = chunk * kChunk;
            use(chunks[chunk], items.subspan(first, std::min(kChunk, items.size() - first)));
        });
    };
    for_chunks([&](DigitCounts& counts, std::span<const CodedItem> chunk) {
        counts.fill(0);
        for (const CodedItem& item : chunk) ++counts[digit_of(item, shift)];
    });
    if (!counts_to_places(chunks, items.size())) return sort_many(items, other, shift, stays);
    const DigitCounts first_of_digit = chunks[0];
    for_chunks([&](DigitCounts& places, std::span<const CodedItem> chunk) {
        for (const CodedItem& item : chunk) other[places[digit_of(item, shift)]++] = item;
    });
    tbb::parallel_for(size_t{0}, kDigits, [&](size_t digit) {
        const size_t first = first_of_digit[digit];
        const size_t count = (digit + 1 < kDigits ? first_of_digit[digit + 1] : items.size()) - first;
        if (count > 0) sort_many(other.subspan(first, count), items.subspan(first, count), shift, !stays);
    });
}

}  // namespace

void sort_by_code(UnsetVector<CodedItem>& items, int bits) {
    UnsetVector<CodedItem> other(items.size());
    sort_many(items, other, bits, true);
}

}  // namespace trapeze
