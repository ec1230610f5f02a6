/// Categories of lights, by which illuminance loops choose among them.
#pragma once

#include <string_view>

namespace trapeze {

/// What a light is in: the names in its output parameter __category, which commas part. 3Delight's lights are
/// in others besides, unless they name one of these themselves: "diffuse" and "specular" where they count in
/// these functions, "ambient" where they have no direction.
struct LightCategories {
    std::string_view named;
    bool ambient = false;
    bool diffuse = true, specular = true;

    /// Blanks around names do not count.
    bool has(std::string_view name) const;
    /// Of a list that is asked for. A comma is "or", "&" is "and" and binds closer. "-" before a name is
    /// "not" where the list has an "&" (3Delight's); else it may begin the list, and means all lights that
    /// the list does not hold (PRMan's). A list of nothing holds all.
    bool fit(std::string_view wanted) const;
};

/// Whether a list asks for ambient lights by that name; other lists do not mean them.
bool names_ambient(std::string_view wanted);

}  // namespace trapeze
