#include "pipeline/study/scenes/rib_writer.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace trapeze::scenes {
namespace {

/// Five digits: small files, and no digits that differ between machines' mathematical functions.
float rounded(double number) {
    char text[32];
    const char* const end =
        fmt::format_to_n(text, sizeof text, "{:.5g}", std::abs(number) < 1e-9 ? 0.0 : number).out;
    float value = 0;
    std::from_chars(text, end, value);
    return value;
}

}  // namespace

RibWriter::RibWriter()
    : writer_(rib::RibEncoding::Ascii, [this](std::string_view bytes) { text_ += bytes; }) {
    writer_.comment("##RenderMan RIB-Structure 1.1");
}

void RibWriter::argument(double number) {
    writer_.number(double{rounded(number)});
}

void RibWriter::argument(std::span<const double> numbers) {
    std::vector<float> floats;
    floats.reserve(numbers.size());
    for (const double number : numbers) floats.push_back(rounded(number));
    writer_.numbers(floats);
}

void RibWriter::moving(std::string_view name, const Numbers& open, const Numbers& close) {
    const auto write = [&](const Numbers& numbers) {
        writer_.request(name);
        for (const double number : numbers) argument(number);
    };
    if (open == close) return write(open);
    request("MotionBegin", Integers{0, 1});
    write(open);
    write(close);
    request("MotionEnd");
}

RibBlock::RibBlock(RibWriter& writer, std::string_view kind) : writer_(writer), kind_(kind) {
    writer_.request(kind_ + "Begin");
}

RibBlock::~RibBlock() {
    writer_.request(kind_ + "End");
}

Numbers flattened(std::span<const V3d> points) {
    Numbers numbers;
    numbers.reserve(3 * points.size());
    for (const V3d& p : points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    return numbers;
}

}  // namespace trapeze::scenes
