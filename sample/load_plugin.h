/// Visibility methods in files of their own [decision 0040].
#pragma once

#include <string>

#include "sample/visibility.h"

namespace trapeze {

/// Adds a row to the table of methods, which all of the process then has. As limit_simd() it is called at the
/// start of a program, before any other work. False with *error set when the name is taken or empty, or the
/// row lacks a function.
bool add_visibility_method(const VisibilityMethod& method, std::string* error);

/// Loads a plugin (sample/plugin.h) and adds its method; the file stays loaded. A file that is loaded a
/// second time is not an error. False with *error set, which names the file, when it is not there, is no
/// shared object, is no plugin, or is of another version.
bool load_plugin(const std::string& file, std::string* error);

}  // namespace trapeze
