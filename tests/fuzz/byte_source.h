/// Values from a fuzzer's bytes, for targets that make their input from them. Zeros when the bytes are used
/// up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace trapeze::fuzz {

class ByteSource {
  public:
    ByteSource(const uint8_t* data, size_t size) : bytes_(data, size) {}

    bool is_empty() const { return bytes_.empty(); }

    uint8_t byte() {
        if (bytes_.empty()) return 0;
        const uint8_t value = bytes_.front();
        bytes_ = bytes_.subspan(1);
        return value;
    }

    /// From `least` to `most`.
    int between(int least, int most) { return least + byte() % (most - least + 1); }

    /// True about once in `n`.
    bool once_in(int n) { return byte() % n == n - 1; }

    /// A number as RIB has it: mostly of ordinary size, sometimes at the borders of what a float can be.
    std::string number() {
        static constexpr const char* kSpecial[] = {
            "0",      "1",      "-1",   "-0",     "1e-45", "1e-30", "1e30",        "-1e30",
            "3.4e38", "-3e38",  "nan",  "-inf",   "1e10",  "1e-7",  "2147483647",  "1e39",
            "0.5",    "1.0001", "1e19", "-1e-20", "1e38",  "16384", "-2147483648", "0.99999"};
        constexpr int kSpecials = sizeof kSpecial / sizeof *kSpecial, kOrdinary = 256 - kSpecials;
        const int value = byte();
        return value < kOrdinary ? std::to_string((value - kOrdinary / 2) / 32.0)
                                 : kSpecial[value - kOrdinary];
    }

    /// The bytes that are left.
    std::span<const uint8_t> rest() const { return bytes_; }

  private:
    std::span<const uint8_t> bytes_;
};

}  // namespace trapeze::fuzz
