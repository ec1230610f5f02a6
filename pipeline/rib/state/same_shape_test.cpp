#include "pipeline/rib/state/same_shape.h"

#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

std::shared_ptr<const Shape> shape_of(const std::string& text) {
    return read_world(text).primitive().shape_keys.front();
}

/// Each is another shape than all others.
const std::string kShapes[] = {
    "Sphere 1 -1 1 360",
    "Sphere 1 -1 1 180",
    "Cylinder 1 -1 1 360",
    "Sphere 1 -1 1 360 \"Cs\" [1 0 0 1 0 0 1 0 0 1 0 0]",
    "Sphere 1 -1 1 360 \"constant float k\" 1",
    "Sphere 1 -1 1 360 \"uniform float k\" 1",
    "Sphere 1 -1 1 360 \"constant string k\" \"a\"",
    "Sphere 1 -1 1 360 \"constant string k\" \"b\"",
    "Polygon \"P\" [0 0 0 1 0 0 0 1 0]",
    "Polygon \"P\" [0 0 0 1 0 0 0 1 1]",
    "PointsPolygons [3] [0 2 1] \"P\" [0 0 0 1 0 0 0 1 0]",
    "SubdivisionMesh \"catmull-clark\" [3] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0]",
    "SubdivisionMesh \"bilinear\" [3] [0 1 2] \"P\" [0 0 0 1 0 0 0 1 0]",
    "SubdivisionMesh \"catmull-clark\" [3] [0 1 2] [\"corner\"] [1 1] [0] [2] \"P\" [0 0 0 1 0 0 0 1 0]",
    "SubdivisionMesh \"catmull-clark\" [3] [0 1 2] [\"corner\"] [1 1] [0] [3] \"P\" [0 0 0 1 0 0 0 1 0]",
    "PatchMesh \"bilinear\" 2 \"nonperiodic\" 2 \"nonperiodic\" \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]",
    "PatchMesh \"bilinear\" 2 \"periodic\" 2 \"nonperiodic\" \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]",
    "Basis \"b-spline\" 1 \"bezier\" 3 Patch \"bilinear\" \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]",
    "NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]",
    "NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 2 2] 0 1 \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]",
    "TrimCurve [1] [2] [0 0 1 2 3 4 4] [0] [4] [5] [0 1 1 0 0] [0 0 1 1 0] [1 1 1 1 1] "
    "NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0 0 0 1 0 0 0 1 0 1 1 0]",
    "Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 1 0 0]",
    "Curves \"linear\" [2] \"periodic\" \"P\" [0 0 0 1 0 0]",
    "Points \"P\" [0 0 0 1 0 0]",
    "Blobby 1 [1001 0] [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] [\"\"]",
    "Blobby 1 [1001 0] [2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] [\"\"]"};

TEST(SameShape, ShapesAreLikeThemselvesAlone) {
    std::vector<std::shared_ptr<const Shape>> shapes, again;
    for (const std::string& text : kShapes) shapes.push_back(shape_of(text)), again.push_back(shape_of(text));
    for (size_t i = 0; i < shapes.size(); ++i)
        for (size_t k = 0; k < shapes.size(); ++k)
            EXPECT_EQ(rib::is_same(*shapes[i], *again[k]), i == k) << kShapes[i] << '\n' << kShapes[k];
}

}  // namespace
}  // namespace trapeze::testing
