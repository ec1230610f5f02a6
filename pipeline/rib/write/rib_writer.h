/// Writes requests as RIB, in ASCII or in RISpec's binary encoding (appendix C.2). What is written reads back
/// as the same requests: numbers are given with as many digits as tell them from their neighbours.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace trapeze::rib {

struct Argument;
struct RequestText;

/// Of the whole stream; the reader takes both, mixed as they like.
enum class RibEncoding { Ascii, Binary };

/// Keeps order and nothing else: whether a request exists and its arguments fit is not looked at.
class RibWriter {
  public:
    /// `write` takes the bytes as they come; it is called with some kilobytes at a time.
    RibWriter(RibEncoding encoding, std::function<void(std::string_view)> write);
    ~RibWriter() { flush(); }
    RibWriter(const RibWriter&) = delete;
    RibWriter& operator=(const RibWriter&) = delete;

    /// Begins a request; its arguments follow. In ASCII it is indented by the blocks that are open.
    void request(std::string_view name);
    /// A number without brackets.
    void number(double value);
    void string(std::string_view text);
    void numbers(std::span<const float> values);  ///< an array
    void integers(std::span<const int> values);   ///< an array
    void strings(std::span<const std::string> values);
    void comment(std::string_view text);  ///< a line of its own; "##..." for structure hints
    /// RIB as it is, in lines of its own; the caller answers for it.
    void verbatim(std::string_view rib) { comment(rib); }

    /// A whole request, as it was read.
    void write(const RequestText& request);
    /// Hands on all that there is. The destructor does so too, but must not throw: where `write` may, call it
    /// before.
    void flush();

  private:
    void begin_line();
    void space();
    void append_number(double value);
    void append_argument(const Argument& argument);
    void append_array(const Argument& argument);
    void append_bytes(uint64_t value, int bytes);
    void put(char byte) { buffer_.push_back(byte); }

    RibEncoding encoding_;
    std::function<void(std::string_view)> write_;
    std::string buffer_;
    int depth_ = 0;                                      ///< open blocks
    bool in_line_ = false;                               ///< ASCII: something stands in the line
    size_t line_start_ = 0;                              ///< in buffer_
    std::map<std::string, uint8_t, std::less<>> codes_;  ///< of requests that have been defined, binary
};

}  // namespace trapeze::rib
