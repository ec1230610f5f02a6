/// The writer that the scenes' generators use: requests with arguments of all kinds, into a text.
/// text.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"
#include "pipeline/rib/write/rib_writer.h"

namespace trapeze::scenes {

using Numbers = std::vector<double>;
using Integers = std::vector<int>;
using Words = std::vector<std::string>;

/// A block that ends with the C++ scope that it is in.
class RibBlock;

class RibWriter {
  public:
    RibWriter();

    const std::string& text() {
        writer_.flush();
        return text_;
    }

    void comment(std::string_view words) { writer_.comment("# " + std::string(words)); }
    void blank_line() { writer_.comment(""); }

    /// Writes a request: numbers as they are, strings in quotes, vectors as arrays.
    template <class... Arguments>
    void request(std::string_view name, const Arguments&... arguments) {
        writer_.request(name);
        (argument(arguments), ...);
    }

    /// Writes a transformation as a motion block from the shutter's opening to its closing; as one request
    /// where the numbers are the same.
    void moving(std::string_view name, const Numbers& open, const Numbers& close);

    RibBlock block(std::string_view kind);  ///< "Attribute": AttributeBegin ... AttributeEnd

  private:
    void argument(double number);
    void argument(int number) { writer_.number(number); }
    void argument(std::string_view text) { writer_.string(text); }
    void argument(const char* text) { writer_.string(text); }
    void argument(std::span<const double> numbers);
    void argument(const Numbers& numbers) { argument(std::span<const double>(numbers)); }
    void argument(const Integers& numbers) { writer_.integers(numbers); }
    void argument(const Words& words) { writer_.strings(words); }

    std::string text_;
    rib::RibWriter writer_;
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

/// The components of points, colours or vectors, one after another.
Numbers flattened(std::span<const V3d> points);

}  // namespace trapeze::scenes
