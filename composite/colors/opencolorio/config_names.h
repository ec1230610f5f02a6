/// Names in a config, found or listed.
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace trapeze {

/// What is wrong with a config or a name in it, as one line.
struct ColorProblem : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Names of the kinds of things that a config has, those that it hides from users left out.
std::vector<std::string> color_spaces_of(const OCIO_NAMESPACE::Config& config);
std::vector<std::string> displays_of(const OCIO_NAMESPACE::Config& config);
std::vector<std::string> views_of(const OCIO_NAMESPACE::Config& config, const std::string& display);
std::vector<std::string> looks_of(const OCIO_NAMESPACE::Config& config);

/// `name` as it stands in `names`, whose letters may be of another case; throws ColorProblem: 'no `what`
/// "name"; there is "A", "B"'.
std::string found_in(const std::vector<std::string>& names, const std::string& name, const std::string& what);

/// The name of a colour space that is given by its name, an alias or a role; throws ColorProblem.
std::string color_space_named(const OCIO_NAMESPACE::Config& config, const std::string& name);

/// The names in one text, in quotes; "none" where there are none.
std::string listed_names(const std::vector<std::string>& names);

}  // namespace trapeze
