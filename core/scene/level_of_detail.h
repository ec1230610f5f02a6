/// Levels of detail in transition (RISpec 4.2.7). Every sample has a number from 0 to 1 and sees those levels
/// in whose range it lies. Ranges of levels that pass into each other add up to all numbers: together they
/// cover what one would cover alone.
#pragma once

#include "core/scene/scene.h"

namespace trapeze {

/// The numbers of the samples that see a primitive.
struct SeenNumbers {
    float from = 0, to = 1;  ///< `to` is not among them

    bool are_all() const { return from <= 0 && to >= 1; }
    bool are_none() const { return !(from < to); }
    bool contain(float number) const { return number >= from && number < to; }
};

/// Which samples see a primitive with these attributes; they keep it as "detail" "seen", unless all samples
/// do.
inline SeenNumbers seen_numbers(const Attributes& attributes) {
    const Parameter* const seen = attributes.user.find("detail", "seen");
    return seen && seen->floats.size() == 2 ? SeenNumbers{seen->floats[0], seen->floats[1]} : SeenNumbers{};
}

inline void set_seen_numbers(Attributes& attributes, const SeenNumbers& numbers) {
    if (numbers.are_all()) return;
    attributes.user.set(
        "detail", {"seen", {StorageClass::Uniform, ValueType::Float, 2}, {numbers.from, numbers.to}, {}});
}

}  // namespace trapeze
