#include "pipeline/study/scenes/rib_writer.h"

#include <fmt/format.h>

#include <cmath>

namespace trapeze::scenes {
namespace {

constexpr size_t kLineLength = 110;

/// Five digits: small files, and no digits that differ between machines' mathematical functions.
std::string number_text(double number) {
    const std::string text = fmt::format("{:.5g}", std::abs(number) < 1e-9 ? 0.0 : number);
    return text.starts_with("0.") ? text.substr(1) : text.starts_with("-0.") ? "-" + text.substr(2) : text;
}

}  // namespace

void RibWriter::comment(std::string_view words) {
    text_ += fmt::format("# {}\n", words);
}

void RibWriter::begin_line(std::string_view name) {
    line_begin_ = text_.size();
    text_.append(static_cast<size_t>(2 * indent_), ' ');
    text_ += name;
}

void RibWriter::word(std::string_view text) {
    if (text_.size() + 1 + text.size() - line_begin_ > kLineLength) {
        text_ += '\n';
        line_begin_ = text_.size();
    }
    text_ += ' ';
    text_ += text;
}

void RibWriter::argument(double number) {
    word(number_text(number));
}

void RibWriter::argument(std::string_view text) {
    word(fmt::format("\"{}\"", text));
}

void RibWriter::argument(std::span<const double> numbers) {
    word("[");
    for (size_t i = 0; i < numbers.size(); ++i) {
        if (i == 0)
            text_ += number_text(numbers[i]);
        else
            word(number_text(numbers[i]));
    }
    text_ += ']';
}

void RibWriter::argument(std::span<const int> numbers) {
    argument(Numbers(numbers.begin(), numbers.end()));
}

void RibWriter::argument(const Words& words) {
    word("[");
    for (const std::string& text : words) word(fmt::format("\"{}\"", text));
    text_ += ']';
}

void RibWriter::moving(std::string_view name, const Numbers& open, const Numbers& close) {
    const auto write = [&](const Numbers& numbers) {
        begin_line(name);
        for (const double number : numbers) argument(number);
        text_ += '\n';
    };
    if (open == close) return write(open);
    request("MotionBegin", Integers{0, 1});
    ++indent_;
    write(open);
    write(close);
    --indent_;
    request("MotionEnd");
}

RibBlock::RibBlock(RibWriter& writer, std::string_view kind) : writer_(writer), kind_(kind) {
    writer_.request(kind_ + "Begin");
    ++writer_.indent_;
}

RibBlock::~RibBlock() {
    --writer_.indent_;
    writer_.request(kind_ + "End");
}

Numbers flattened(std::span<const V3d> points) {
    Numbers numbers;
    numbers.reserve(3 * points.size());
    for (const V3d& p : points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    return numbers;
}

}  // namespace trapeze::scenes
