#include "pipeline/compare/value_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

/// Three digits that count, all those before the point.
std::string three_digits(double value) {
    if (value == 0) return "0";
    const double rounded = std::stod(fmt::format("{:.2e}", value));  // may have a digit more before the point
    const int before = static_cast<int>(std::floor(std::log10(std::abs(rounded)))) + 1;
    return fmt::format("{:.{}f}", value, std::clamp(3 - before, 0, 9));
}

}  // namespace

std::string seconds_text(double seconds) {
    return seconds < 0.9995 ? three_digits(seconds * 1e3) + " ms" : three_digits(seconds) + " s";
}

std::string number_text(double value) {
    const double size = std::abs(value);
    if (size != 0 && (size < 1e-3 || size >= 1e7)) return fmt::format("{:.2e}", value);
    return three_digits(value);
}

std::string counted_text(double value) {
    return value == 0 ? "-" : number_text(value);
}

std::string count_text(double count) {
    return count < 1e6 ? three_digits(count) : three_digits(count * 1e-6) + " million";
}

}  // namespace trapeze
