/// Code arrays of Blobby, made from bytes: what they refer to is there mostly, so that any program on any
/// leaves comes as far as grids. Built and replayed as rib_fuzz.cpp is, with tests/fuzz/seeds/blobby as
/// corpus.
#include <algorithm>
#include <string>

#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/dice_text.h"

namespace {

using trapeze::fuzz::ByteSource;

class BlobbyText {
  public:
    BlobbyText(const uint8_t* data, size_t size) : bytes_(data, size) {}

    std::string world() {
        std::string text;
        if (bytes_.once_in(8)) text += "Scale " + bytes_.number() + " " + bytes_.number() + " 1\n";
        if (!bytes_.once_in(4)) return text + blobby();
        text += "MotionBegin [0 1]\n" + blobby();
        return text + blobby() + "MotionEnd\n";
    }

  private:
    std::string blobby() {
        constexpr int kMostSteps = 24;
        code_.clear(), floats_.clear();
        leaves_ = results_ = float_count_ = 0;
        for (int i = bytes_.between(1, kMostSteps); i > 0; --i) {
            if (results_ == 0 || bytes_.once_in(2))
                leaf();
            else
                operation();
            ++results_;
        }
        if (results_ > 1) add_all();
        return "Blobby " + std::to_string(leaves_) + " [" + code_ + "] [" + floats_ + "] [\"\" \"none.z\"]" +
               variables() + "\n";
    }

    void add(int value) { code_ += std::to_string(value) + " "; }

    /// An index in an array of `count`, hardly ever outside.
    void add_index(int count) {
        add(bytes_.once_in(256) ? count : bytes_.between(0, std::max(count, 1) - 1));
    }

    void add_float(const std::string& number) { floats_ += number + " ", ++float_count_; }

    /// A scale and a place, or anything.
    void matrix() {
        const bool any = bytes_.once_in(8);
        const std::string scale = any ? "" : bytes_.number();
        for (int i = 0; i < 16; ++i) {
            const bool diagonal = i % 5 == 0, translation = i >= 12;
            add_float(any || (translation && i < 15) ? bytes_.number()
                      : i == 15                      ? "1"
                      : diagonal                     ? scale
                                                     : "0");
        }
    }

    /// Constant, ellipsoid, segment or repelling plane, with floats of its own or those of another.
    void leaf() {
        static constexpr int kFloats[] = {1, 16, 23, 4};
        const int kind = bytes_.once_in(2) ? 1 : bytes_.between(0, 3);
        add(1000 + kind);
        if (kind == 3) add_index(2);
        ++leaves_;
        if (bytes_.once_in(8) && float_count_ > kFloats[kind]) {
            add_index(float_count_ - kFloats[kind]);
            return;
        }
        add(float_count_);
        const int loose = kind == 1 ? 0 : kind == 2 ? 7 : kFloats[kind];
        for (int i = 0; i < loose; ++i) add_float(bytes_.number());
        if (kind == 1 || kind == 2) matrix();
    }

    /// Sum, product, maximum, minimum of some; difference, quotient; negation, identity.
    void operation() {
        constexpr int kMostOperands = 6;
        const int code = bytes_.between(0, 7);
        add(code);
        int operands = code < 6 ? 2 : 1;
        if (code < 4) add(operands = bytes_.between(1, kMostOperands));
        for (int i = 0; i < operands; ++i) add_index(results_);
    }

    /// What comes last is the surface: the sum of everything, often.
    void add_all() {
        if (!bytes_.once_in(2)) return;
        add(0), add(results_);
        for (int i = 0; i < results_; ++i) add(i);
    }

    std::string variables() {
        if (!bytes_.once_in(4)) return {};
        std::string text = " \"varying color Cs\" [";
        for (int i = 0; i < 3 * leaves_; ++i) text += bytes_.number() + " ";
        return text + "]";
    }

    ByteSource bytes_;
    std::string code_, floats_;
    int leaves_ = 0, results_ = 0, float_count_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    trapeze::fuzz::dice_world(BlobbyText(data, size).world());
    return 0;
}
