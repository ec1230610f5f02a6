/// For tests: for each overload of each built-in function a piece of a shader that calls it, and what it
/// makes of it, written out by other means.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace trapeze::testing {

/// One call. `code` sets r from the floats X and Y, `expected` is what r must be at a vertex. `flat`, where
/// it is given, takes the place of `expected` in runs where X and Y are the same at all vertices: there,
/// derivatives are 0.
struct BuiltinCase {
    std::string code;
    std::function<double(double x, double y)> expected;
    double tolerance = 2e-6;
    std::function<double(double x, double y)> flat = {};
};

/// Numbers: sections 15.1 and 15.5 of RISpec 3.2.
std::vector<BuiltinCase> number_cases();
/// Noises, splines and what looks at neighbours.
std::vector<BuiltinCase> pattern_cases();
/// Points, vectors, colours and matrices: 15.2 to 15.4.
std::vector<BuiltinCase> geometry_cases();
/// What asks others: lights, rays, maps and messages (15.6 to 15.8), as builtin_overloads_test.cpp answers.
std::vector<BuiltinCase> asking_cases();

}  // namespace trapeze::testing
