/// Room for many values that are each made once, in parallel. A vector would make all of them first, on one
/// thread, which takes as long as many a pass over them.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace trapeze {

/// Whoever makes it sets every value before it is read.
template <class T>
class UnsetArray {
    // Which values have been set is not kept, so none is destroyed.
    static_assert(std::is_trivially_destructible_v<T>);

  public:
    explicit UnsetArray(size_t size = 0)
        : values_(size > 0 ? std::allocator<T>().allocate(size) : nullptr, {size}) {}

    /// Of different indices from different threads at once.
    void set(size_t index, const T& value) { std::construct_at(values_.get() + index, value); }
    const T* data() const { return values_.get(); }
    const T& operator[](size_t index) const { return values_.get()[index]; }
    size_t size() const { return values_.get_deleter().size; }
    size_t bytes() const { return size() * sizeof(T); }

  private:
    struct Release {
        size_t size = 0;
        void operator()(T* values) const { std::allocator<T>().deallocate(values, size); }
    };
    std::unique_ptr<T, Release> values_;
};

}  // namespace trapeze
