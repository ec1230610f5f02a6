/// Writes RIB as text: requests, one a line, arrays broken at the line's end.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"

namespace trapeze::scenes {

using Numbers = std::vector<double>;
using Integers = std::vector<int>;
using Words = std::vector<std::string>;

/// A block that ends with the scope.
class RibBlock;

class RibWriter {
  public:
    const std::string& text() const { return text_; }

    void comment(std::string_view words);
    void blank_line() { text_ += '\n'; }

    /// Numbers as they are, strings in quotes, vectors as arrays.
    template <class... Arguments>
    void request(std::string_view name, const Arguments&... arguments) {
        begin_line(name);
        (argument(arguments), ...);
        text_ += '\n';
    }

    /// A transformation at the shutter's opening and closing; once where these are the same.
    void moving(std::string_view name, const Numbers& open, const Numbers& close);

    RibBlock block(std::string_view kind);  ///< "Attribute": AttributeBegin ... AttributeEnd

  private:
    friend class RibBlock;
    void begin_line(std::string_view name);
    void word(std::string_view text);  ///< after a space or a line's end
    void argument(double number);
    void argument(int number) { argument(static_cast<double>(number)); }
    void argument(std::string_view text);
    void argument(const char* text) { argument(std::string_view(text)); }
    void argument(std::span<const double> numbers);
    void argument(std::span<const int> numbers);
    void argument(const Numbers& numbers) { argument(std::span<const double>(numbers)); }
    void argument(const Integers& numbers) { argument(std::span<const int>(numbers)); }
    void argument(const Words& words);

    std::string text_ = "##RenderMan RIB-Structure 1.1\n";
    size_t line_begin_ = 0;
    int indent_ = 0;
};

class RibBlock {
  public:
    RibBlock(RibWriter& writer, std::string_view kind);
    ~RibBlock();
    RibBlock(const RibBlock&) = delete;
    RibBlock& operator=(const RibBlock&) = delete;

  private:
    RibWriter& writer_;
    std::string kind_;
};

inline RibBlock RibWriter::block(std::string_view kind) {
    return RibBlock(*this, kind);
}

/// The numbers of points, colours or vectors one after another.
Numbers flattened(std::span<const V3d> points);

}  // namespace trapeze::scenes
