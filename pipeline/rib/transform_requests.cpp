/// RISpec 4.3.
#include "pipeline/rib/request_table.h"

namespace trapeze::rib {
namespace {

template <TransformKind kKind, size_t kCount>
void concat(Reader& r, ArgumentCursor& c) {
    r.transform(kKind, c.numbers(kCount, "the transformation"));
}

void set_transform(Reader& r, ArgumentCursor& c) {
    const TransformArguments matrix = c.numbers(16, "the matrix");
    r.set_transform(&matrix);
}

constexpr RequestRow kRows[] = {
    {"Identity", [](Reader& r, ArgumentCursor&) { r.set_transform(nullptr); }},
    {"Transform", set_transform},
    {"ConcatTransform", concat<TransformKind::Matrix, 16>},
    {"Translate", concat<TransformKind::Translate, 3>},
    {"Rotate", concat<TransformKind::Rotate, 4>},
    {"Scale", concat<TransformKind::Scale, 3>},
    {"Skew", concat<TransformKind::Skew, 7>},
    {"Perspective", concat<TransformKind::Perspective, 1>},
    {"CoordinateSystem",
     [](Reader& r, ArgumentCursor& c) { r.name_coordinate_system(c.string("the name")); }},
    {"CoordSysTransform",
     [](Reader& r, ArgumentCursor& c) { r.use_coordinate_system(c.string("the name")); }},
};

}  // namespace

std::span<const RequestRow> transform_requests() {
    return kRows;
}

}  // namespace trapeze::rib
