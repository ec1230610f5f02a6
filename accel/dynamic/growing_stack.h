/// A stack that needs no memory of its own until it is deep.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace trapeze {

/// For a traversal of a tree whose depth nothing bounds.
template <class Value>
class GrowingStack {
  public:
    bool empty() const { return size_ == 0; }
    void push(const Value& value) {
        if (size_ < kShallow)
            shallow_[size_] = value;
        else
            deep_.push_back(value);
        ++size_;
    }
    /// Of one that is not empty.
    Value pop() {
        --size_;
        if (size_ < kShallow) return shallow_[size_];
        const Value value = deep_.back();
        deep_.pop_back();
        return value;
    }

  private:
    static constexpr size_t kShallow = 96;
    std::array<Value, kShallow> shallow_;
    std::vector<Value> deep_;
    size_t size_ = 0;
};

}  // namespace trapeze
