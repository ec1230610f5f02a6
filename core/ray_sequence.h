/// Points of the unit square for a vertex' rays [decision 0019].
#pragma once

#include <cstdint>

#include "core/math.h"

namespace trapeze {

/// A point of the unit square for each of a call's rays: Hammersley's points, shifted by random numbers that
/// follow from the seed (Cranley and Patterson's rotation).
class RaySequence {
  public:
    RaySequence(uint32_t seed, int count);
    V2f operator[](int i) const;

  private:
    uint32_t scramble_;
    float shift_;
    int count_;
};

}  // namespace trapeze
