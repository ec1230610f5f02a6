#include "core/grid.h"

#include <algorithm>
#include <cstdlib>

#include "core/memory/large_pages.h"

namespace trapeze {
namespace {

/// Bytes: what a grid's memory is aligned to.
constexpr size_t kAlignment = 64;
constexpr size_t kReadable = 64;  // past the end of every grid, for whole vectors

size_t aligned(size_t size) {
    return (size + kAlignment - 1) & ~(kAlignment - 1);
}

}  // namespace

void GridArena::Free::operator()(std::byte* p) const {
    std::free(p);
}

std::byte* GridArena::take(size_t size) {
    size = aligned(size);
    if (size > left_) {
        // The first ones are small, since most scenes are; later ones are large pages, as soon as one that is
        // nearly empty adds no more than an eighth: regions are cut to fit the memory.
        const bool many = bytes_ >= 8 * kLargePage && chunk_bytes_ >= kDefaultChunk;
        const size_t chunk = std::max(size, many ? kLargePage - kReadable : chunk_bytes_);
        chunks_.emplace_back(static_cast<std::byte*>(large_memory(chunk + kReadable)));
        next_ = chunks_.back().get();
        left_ = chunk;
        bytes_ += chunk;
    }
    std::byte* taken = next_;
    next_ += size, left_ -= size;
    return taken;
}

void GridArena::allocate(Grid& grid) {
    const size_t floats = static_cast<size_t>(grid.plane_count()) * grid.shape.plane_size();
    const size_t aovs = static_cast<size_t>(grid.aov_channels) * grid.shape.vertex_count();
    grid.positions = reinterpret_cast<float*>(take(floats * sizeof(float)));
    grid.colors = take(grid.color_bytes() + aovs * sizeof(float));
}

uint64_t Grids::micropolygon_count() const {
    uint64_t count = 0;
    for (const Grid& grid : grids) count += grid.shape.micropolygon_count();
    return count;
}

size_t Grids::bytes() const {
    size_t total = grids.capacity() * sizeof(Grid);
    for (const GridArena& arena : arenas) total += arena.bytes();
    return total;
}

int Grids::max_key_count() const {
    int keys = 1;
    for (const Grid& grid : grids) keys = std::max<int>(keys, grid.key_count);
    return keys;
}

}  // namespace trapeze
