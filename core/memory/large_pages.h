/// Memory for arrays of many values: in pages of two mebibytes where the system has them, and not written
/// before its values are. A page that is touched first waits for the system, on virtual machines for
/// microseconds: with pages of 4 KB that was two thirds of the time of the fastest builders of trees. And
/// large pages spare reads of other places the search for where a page is.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace trapeze {

inline constexpr size_t kLargePage = size_t{1} << 21;  ///< bytes

/// Memory aligned to 64 bytes; from kLargePage on to that, and in large pages. Given back by std::free().
/// Throws std::bad_alloc.
void* large_memory(size_t bytes);

/// An allocator of large_memory().
template <class T>
struct LargePages {
    using value_type = T;

    LargePages() = default;
    template <class U>
    explicit(false) LargePages(const LargePages<U>&) {}

    T* allocate(size_t count) {
        if (count > ~size_t{0} / 2 / sizeof(T)) throw std::bad_array_new_length();
        return static_cast<T*>(large_memory(count * sizeof(T)));
    }
    void deallocate(T* memory, size_t) { std::free(memory); }
    bool operator==(const LargePages&) const { return true; }
};

/// LargePages that leaves unset what a vector would set to nothing first, on one thread, which takes as long
/// as many a pass over it.
template <class T>
struct UnsetPages : LargePages<T> {
    // Which values have been set is not kept, so none is destroyed.
    static_assert(std::is_trivially_destructible_v<T>);
    template <class U>
    struct rebind {
        using other = UnsetPages<U>;
    };

    UnsetPages() = default;
    template <class U>
    explicit(false) UnsetPages(const UnsetPages<U>&) {}

    template <class U>
    void construct(U*) {}
    template <class U, class... Values>
    void construct(U* at, Values&&... values) {
        std::construct_at(at, std::forward<Values>(values)...);
    }
};

/// Values that resize() adds are set by whoever asks for them, each before it is read; in parallel, if need
/// be.
template <class T>
using UnsetVector = std::vector<T, UnsetPages<T>>;

}  // namespace trapeze
