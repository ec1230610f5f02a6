/// What gather() wants to know of what its rays hit: "surface:Cs", "primitive:P", "attribute:user:level".
#pragma once

#include <string>
#include <vector>

namespace trapeze {

/// One value that is wanted, and where it stands among a hit's answers.
struct HitOutput {
    enum class Of : unsigned char { Surface, Displacement, Volume, Primitive, Attribute };
    Of of = Of::Surface;
    std::string name;  ///< without "surface:"
    int width = 3;     ///< numbers: 1 or 3
    /// Among a hit's answers (ShadingGrid::answers): 1 where the hit has the value, else 0; the numbers
    /// follow.
    size_t at = 0;

    /// Whether it is known without running the hit's shaders.
    bool is_of_primitive() const { return of == Of::Primitive || of == Of::Attribute; }
};

struct HitOutputs {
    std::vector<HitOutput> all;
    size_t size = 0;  ///< of a hit's answers

    bool empty() const { return all.empty(); }
    /// Whether shaders have to run for any of them.
    bool ask_shaders() const {
        for (const HitOutput& output : all)
            if (!output.is_of_primitive()) return true;
        return false;
    }
};

}  // namespace trapeze
