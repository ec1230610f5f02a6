/// NuPatches and the loops that trim them, made from bytes: arrays have the lengths that they should have
/// mostly, so that knots, weights and points of any value come as far as grids. Built and replayed as
/// rib_fuzz.cpp is, with tests/fuzz/seeds/nurbs as corpus.
#include <string>

#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/dice_text.h"

namespace {

using trapeze::fuzz::ByteSource;

class NurbsText {
  public:
    NurbsText(const uint8_t* data, size_t size) : bytes_(data, size) {}

    std::string world() {
        constexpr int kMostPatches = 2;
        for (int i = 0; i < kMostPatches && !bytes_.is_empty(); ++i) {
            if (bytes_.once_in(2)) trim_curve();
            if (bytes_.once_in(4)) text_ += "Attribute \"trimcurve\" \"string sense\" [\"outside\"]\n";
            if (bytes_.once_in(8)) scale();
            if (bytes_.once_in(4))
                moving_patch();
            else
                patch();
        }
        return text_;
    }

  private:
    void add(const std::string& word) { text_ += word + " "; }
    void open() { text_ += "["; }
    void close() { text_ += "] "; }

    /// A count that is one off now and then.
    int about(int count) { return bytes_.once_in(256) ? count - 1 : count; }

    void scale() {
        add("Scale");
        for (int i = 0; i < 3; ++i) add(bytes_.number());
    }

    /// Ascending mostly; the number at which they end.
    double knots(int order, int points) {
        const int kind = bytes_.byte() % 4, count = about(order + points);
        double knot = 0;
        for (int i = 0; i < count; ++i) {
            if (kind == 0) {  // clamped, uniform
                if (i >= order && i <= points) knot += 1;
            } else if (kind == 1) {
                static constexpr double kSteps[] = {0, 1, 0, .25, 1e-7, 3, 0, 1e30};
                knot += kSteps[bytes_.byte() % 8];
            } else if (kind == 2) {  // not clamped
                knot += 1;
            } else {
                add(bytes_.number());
                continue;
            }
            add(std::to_string(knot));
        }
        return knot;
    }

    /// Where the parameter begins and ends.
    void range(double end, std::string& first, std::string& last) {
        const bool any = bytes_.once_in(8);
        first = any ? bytes_.number() : "0";
        last = any ? bytes_.number() : std::to_string(end);
    }

    void trim_curve() {
        constexpr int kMostLoops = 3, kMostCurves = 3, kMostOrder = 6, kMorePoints = 6;
        std::string loops, orders, begins, ends, counts, all_knots;
        int points = 0;
        std::swap(text_, all_knots);  // knots() appends to the text
        const int loop_count = bytes_.between(0, kMostLoops);
        for (int l = 0; l < loop_count; ++l) {
            const int curves = bytes_.between(l == 0 ? 1 : 0, kMostCurves);
            loops += std::to_string(curves) + " ";
            for (int i = 0; i < curves; ++i) {
                const int order = bytes_.between(2, kMostOrder);
                const int count = order + bytes_.between(0, kMorePoints);
                std::string begin, end;
                range(knots(order, count), begin, end);
                orders += std::to_string(order) + " ", counts += std::to_string(count) + " ";
                begins += begin + " ", ends += end + " ";
                points += count;
            }
        }
        std::swap(text_, all_knots);
        text_ += "TrimCurve [" + loops + "] [" + orders + "] [" + all_knots + "] [" + begins + "] [" + ends +
                 "] [" + counts + "] ";
        const bool in_unit_square = !bytes_.once_in(8);
        for (int axis = 0; axis < 3; ++axis) {
            open();
            for (int i = about(points); i > 0; --i) add(trim_coordinate(axis, in_unit_square));
            close();
        }
        text_ += "\n";
    }

    std::string trim_coordinate(int axis, bool in_unit_square) {
        if (axis == 2 && bytes_.byte() < 200) return "1";  // a weight
        return in_unit_square ? std::to_string(bytes_.byte() / 255.) : bytes_.number();
    }

    struct Sizes {
        int nu, nv, u_order, v_order;
    };

    /// Everything up to the control points.
    Sizes topology() {
        constexpr int kMostOrder = 8, kMorePoints = 3;
        Sizes sizes{};
        for (int axis = 0; axis < 2; ++axis) {
            const int order = bytes_.between(2, kMostOrder), points = order + bytes_.between(0, kMorePoints);
            add(std::to_string(points)), add(std::to_string(order));
            open();
            const double end = knots(order, points);
            close();
            std::string first, last;
            range(end, first, last);
            add(first), add(last);
            (axis == 0 ? sizes.nu : sizes.nv) = points;
            (axis == 0 ? sizes.u_order : sizes.v_order) = order;
        }
        return sizes;
    }

    void control_points(const Sizes& sizes) {
        const bool weights = bytes_.once_in(2), flat = bytes_.once_in(2);
        text_ += weights ? "\"Pw\" [" : "\"P\" [";
        for (int v = 0; v < sizes.nv; ++v)
            for (int u = 0; u < sizes.nu; ++u) {
                if (flat)
                    text_ += std::to_string(u - sizes.nu / 2) + " " + std::to_string(v - sizes.nv / 2) + " ";
                for (int k = flat ? 2 : 0; k < (weights ? 4 : 3); ++k) add(bytes_.number());
            }
        close();
        if (bytes_.once_in(4)) {
            text_ += "\"vertex color Cs\" [";
            for (int i = about(3 * sizes.nu * sizes.nv); i > 0; --i) add(bytes_.number());
            close();
        }
        text_ += "\n";
    }

    void patch() {
        text_ += "NuPatch ";
        control_points(topology());
    }

    void moving_patch() {
        text_ += "MotionBegin [0 1]\nNuPatch ";
        const size_t begin = text_.size();
        const Sizes sizes = topology();
        const std::string same = text_.substr(begin);
        control_points(sizes);
        text_ += "NuPatch " + same;
        control_points(sizes);
        text_ += "MotionEnd\n";
    }

    ByteSource bytes_;
    std::string text_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    trapeze::fuzz::dice_world(NurbsText(data, size).world());
    return 0;
}
