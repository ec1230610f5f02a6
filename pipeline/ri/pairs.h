/// A parameter list that came as "...": pairs of token and pointer up to RI_NULL.
#pragma once

#include <array>
#include <cstdarg>
#include <cstddef>

#include "pipeline/ri/ri.h"

namespace trapeze::ri {

/// Lists end after so many pairs even without RI_NULL: one that is not closed reads the stack. The reader of
/// RIB takes no longer ones either.
inline constexpr int kMostPairs = 1000;

/// The pairs of one call, as arrays that the V form of the call takes.
class PairList {
  public:
    /// Takes `arguments` up to the end of the list; va_end remains the caller's.
    explicit PairList(va_list arguments) {
        while (count_ < kMostPairs) {
            const auto token = va_arg(arguments, RtToken);
            if (!token) break;
            tokens_[static_cast<std::size_t>(count_)] = token;
            values_[static_cast<std::size_t>(count_++)] = va_arg(arguments, RtPointer);
        }
    }

    RtInt count() const { return count_; }
    RtToken* tokens() { return tokens_.data(); }
    RtPointer* values() { return values_.data(); }

  private:
    int count_ = 0;
    std::array<RtToken, kMostPairs> tokens_;
    std::array<RtPointer, kMostPairs> values_;
};

}  // namespace trapeze::ri
