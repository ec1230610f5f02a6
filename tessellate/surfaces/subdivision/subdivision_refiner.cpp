#include "tessellate/surfaces/subdivision/subdivision_refiner.h"

#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <optional>
#include <string>

namespace trapeze {
namespace {

using OpenSubdiv::Far::TopologyRefiner;
using OpenSubdiv::Far::TopologyRefinerFactory;
using SdcOptions = OpenSubdiv::Sdc::Options;

/// Beyond these a face's limit surface takes more than 100 MB: Bfr's weights grow with their square.
constexpr int kMostCorners = 256, kMostFaces = 1024;

/// What OpenSubdiv's factory reads, through the specialised members below.
struct RefinerInput {
    const SubdivisionMesh& mesh;
    const SubdivisionTags& tags;
    std::span<const FaceVaryingTopology> channels;
};

/// Reads one tag after another; problems are reported with the tag's name.
class TagReader {
  public:
    TagReader(const SubdivisionMesh& mesh, SourceLocation location, Diagnostics& diagnostics)
        : mesh_(mesh), location_(location), diagnostics_(diagnostics) {}

    SubdivisionTags read();

  private:
    using Tag = SubdivisionMesh::Tag;

    /// Reads a tag about creases, corners or holes; false when it is another.
    bool read_geometry(const Tag& tag);
    /// Reads a tag about rules for the whole mesh; false when it is another.
    bool read_option(const Tag& tag);
    /// A chain of vertices, each two neighbours an edge; one sharpness for all or one for each edge.
    void crease(const Tag& tag);
    /// Vertices; one sharpness for all or one for each.
    void corner(const Tag& tag);
    std::optional<int> choice(const Tag& tag, int fallback, int last) const;
    /// Whether all indices are below `count` and there are one or so many sharpnesses; else a warning.
    bool checked(const Tag& tag, int count, size_t sharpnesses) const;
    void warn(const Tag& tag, const std::string& text) const {
        diagnostics_.warning(location_, "SubdivisionMesh: tag \"" + tag.name + "\": " + text + "; ignored",
                             "subdivision-tag-" + tag.name);
    }

    const SubdivisionMesh& mesh_;
    SourceLocation location_;
    Diagnostics& diagnostics_;
    SubdivisionTags tags_;
    int face_varying_rule_ = 0;
    bool propagate_corners_ = false;
};

SubdivisionTags TagReader::read() {
    for (const Tag& tag : mesh_.tags)
        if (!read_geometry(tag) && !read_option(tag)) warn(tag, "not known");
    // PRMan's numbers, as USD's conversion to them has it: 0 bilinear, 1 edge and corner, 2 edge only, 3
    // always sharp. Variables of class facevertex are never bilinear: 1 for them in place of 0.
    tags_.linear_face_varying = face_varying_rule_ == 0;
    SdcOptions::FVarLinearInterpolation rule =
        propagate_corners_ ? SdcOptions::FVAR_LINEAR_CORNERS_PLUS2 : SdcOptions::FVAR_LINEAR_CORNERS_PLUS1;
    if (face_varying_rule_ == 2) rule = SdcOptions::FVAR_LINEAR_NONE;
    if (face_varying_rule_ == 3) rule = SdcOptions::FVAR_LINEAR_BOUNDARIES;
    tags_.options.SetFVarLinearInterpolation(rule);
    return std::move(tags_);
}

/// The tag's one integer, 0 .. last; `fallback` where it has none, nothing (and a warning) where it is
/// another.
std::optional<int> TagReader::choice(const Tag& tag, int fallback, int last) const {
    const int value = tag.ints.empty() ? fallback : tag.ints[0];
    if (value >= 0 && value <= last) return value;
    warn(tag, "wants 0 to " + std::to_string(last) + ", has " + std::to_string(value));
    return std::nullopt;
}

/// A tag has one sharpness for all that it names, or one for each.
bool TagReader::checked(const Tag& tag, int count, size_t sharpnesses) const {
    if (tag.floats.size() != 1 && tag.floats.size() != sharpnesses && sharpnesses > 0) {
        warn(tag, "wants 1 or " + std::to_string(sharpnesses) + " floats, has " +
                      std::to_string(tag.floats.size()));
        return false;
    }
    const auto bad =
        std::find_if(tag.ints.begin(), tag.ints.end(), [&](int i) { return i < 0 || i >= count; });
    if (bad == tag.ints.end()) return true;
    warn(tag, "index " + std::to_string(*bad) + " is outside the mesh");
    return false;
}

/// A sharpness within OpenSubdiv's range; NaN and negative ones are smooth.
float limited(float sharpness) {
    return sharpness > 0 ? std::min(sharpness, OpenSubdiv::Sdc::Crease::SHARPNESS_INFINITE) : 0;
}

void TagReader::crease(const Tag& tag) {
    if (tag.ints.size() < 2) return warn(tag, "wants two vertices or more");
    if (!checked(tag, mesh_.vertex_count, tag.ints.size() - 1)) return;
    for (size_t i = 0; i + 1 < tag.ints.size(); ++i)
        tags_.creases.push_back(
            {tag.ints[i], tag.ints[i + 1], limited(tag.floats[tag.floats.size() == 1 ? 0 : i])});
}

void TagReader::corner(const Tag& tag) {
    if (tag.ints.empty() || !checked(tag, mesh_.vertex_count, tag.ints.size())) return;
    for (size_t i = 0; i < tag.ints.size(); ++i)
        tags_.corners.push_back({tag.ints[i], limited(tag.floats[tag.floats.size() == 1 ? 0 : i])});
}

bool TagReader::read_geometry(const Tag& tag) {
    if (tag.name == "crease")
        crease(tag);
    else if (tag.name == "corner")
        corner(tag);
    else if (tag.name == "hole") {
        if (checked(tag, static_cast<int>(mesh_.vertices_per_face.size()), 0))
            tags_.holes.insert(tags_.holes.end(), tag.ints.begin(), tag.ints.end());
    } else
        return false;
    return true;
}

/// RISpec 3.2 has the first of them alone; the others are PRMan's.
bool TagReader::read_option(const Tag& tag) {
    if (tag.name == "interpolateboundary") {
        constexpr SdcOptions::VtxBoundaryInterpolation rules[] = {SdcOptions::VTX_BOUNDARY_NONE,
                                                                  SdcOptions::VTX_BOUNDARY_EDGE_AND_CORNER,
                                                                  SdcOptions::VTX_BOUNDARY_EDGE_ONLY};
        if (const auto rule = choice(tag, 1, 2)) tags_.options.SetVtxBoundaryInterpolation(rules[*rule]);
    } else if (tag.name == "facevaryinginterpolateboundary") {
        face_varying_rule_ = choice(tag, 1, 3).value_or(face_varying_rule_);
    } else if (tag.name == "facevaryingpropagatecorners") {
        propagate_corners_ = choice(tag, 1, 1).value_or(0) == 1;
    } else if (tag.name == "creasemethod") {
        const std::string method = tag.strings.empty() ? "normal" : tag.strings[0];
        if (method != "normal" && method != "chaikin")
            warn(tag, "wants \"normal\" or \"chaikin\", has \"" + method + "\"");
        else
            tags_.options.SetCreasingMethod(method == "chaikin" ? SdcOptions::CREASE_CHAIKIN
                                                                : SdcOptions::CREASE_UNIFORM);
    } else if (tag.name == "smoothtriangles") {
        // An integer that is not 0, or a string, as OpenSubdiv's own shapes have it.
        const bool smooth =
            !tag.strings.empty() ? tag.strings[0] == "smooth" : (tag.ints.empty() || tag.ints[0] != 0);
        tags_.options.SetTriangleSubdivision(smooth ? SdcOptions::TRI_SUB_SMOOTH
                                                    : SdcOptions::TRI_SUB_CATMARK);
    } else
        return false;
    return true;
}

OpenSubdiv::Sdc::SchemeType scheme_type(SubdivisionMesh::Scheme scheme) {
    switch (scheme) {
        case SubdivisionMesh::Scheme::Loop:
            return OpenSubdiv::Sdc::SCHEME_LOOP;
        case SubdivisionMesh::Scheme::Bilinear:
            return OpenSubdiv::Sdc::SCHEME_BILINEAR;
        case SubdivisionMesh::Scheme::CatmullClark:
            break;
    }
    return OpenSubdiv::Sdc::SCHEME_CATMARK;
}

/// What OpenSubdiv would refuse, in words; empty when it takes the mesh.
std::string reason_to_refuse(const SubdivisionMesh& mesh) {
    // Faces at each vertex, counted on the way.
    std::vector<int> valence(mesh.vertex_count);
    size_t corner = 0;
    for (size_t face = 0; face < mesh.vertices_per_face.size(); ++face) {
        const int size = mesh.vertices_per_face[face];
        const std::string name = "face " + std::to_string(face);
        if (size < 3 || corner + size > mesh.vertices.size()) return name + " has too few vertices";
        if (size > kMostCorners) return name + " has more than " + std::to_string(kMostCorners) + " vertices";
        if (mesh.scheme == SubdivisionMesh::Scheme::Loop && size != 3)
            return name + " is not a triangle, as scheme \"loop\" wants";
        const int* v = mesh.vertices.data() + corner;
        for (int i = 0; i < size; ++i) {
            if (v[i] < 0 || v[i] >= mesh.vertex_count) return name + " has a vertex outside the mesh";
            if (++valence[v[i]] > kMostFaces)
                return "vertex " + std::to_string(v[i]) + " has more than " + std::to_string(kMostFaces) +
                       " faces";
        }
        corner += size;
    }
    return {};
}

}  // namespace
}  // namespace trapeze

namespace OpenSubdiv {
namespace OPENSUBDIV_VERSION {
namespace Far {

/// OpenSubdiv calls these specialisations in turn as it builds a refiner: sizes first, then vertices of
/// faces, tags, and values of face-varying channels.
template <>
bool TopologyRefinerFactory<trapeze::RefinerInput>::resizeComponentTopology(
    TopologyRefiner& refiner, trapeze::RefinerInput const& input) {
    const trapeze::SubdivisionMesh& mesh = input.mesh;
    setNumBaseVertices(refiner, mesh.vertex_count);
    setNumBaseFaces(refiner, static_cast<int>(mesh.vertices_per_face.size()));
    for (size_t i = 0; i < mesh.vertices_per_face.size(); ++i)
        setNumBaseFaceVertices(refiner, static_cast<Index>(i), mesh.vertices_per_face[i]);
    return true;
}

template <>
bool TopologyRefinerFactory<trapeze::RefinerInput>::assignComponentTopology(
    TopologyRefiner& refiner, trapeze::RefinerInput const& input) {
    const int* vertex = input.mesh.vertices.data();
    for (int face = 0; face < getNumBaseFaces(refiner); ++face) {
        IndexArray vertices = getBaseFaceVertices(refiner, face);
        std::copy_n(vertex, vertices.size(), vertices.begin());
        vertex += vertices.size();
    }
    return true;
}

template <>
bool TopologyRefinerFactory<trapeze::RefinerInput>::assignComponentTags(TopologyRefiner& refiner,
                                                                        trapeze::RefinerInput const& input) {
    for (const auto& crease : input.tags.creases) {
        // Creases along no edge are told of later, in make_refiner().
        const Index edge = findBaseEdge(refiner, crease.a, crease.b);
        if (edge != INDEX_INVALID) setBaseEdgeSharpness(refiner, edge, crease.sharpness);
    }
    for (const auto& corner : input.tags.corners)
        setBaseVertexSharpness(refiner, corner.vertex, corner.sharpness);
    for (int face : input.tags.holes) setBaseFaceHole(refiner, face, true);
    return true;
}

template <>
bool TopologyRefinerFactory<trapeze::RefinerInput>::assignFaceVaryingTopology(
    TopologyRefiner& refiner, trapeze::RefinerInput const& input) {
    for (const trapeze::FaceVaryingTopology& channel : input.channels) {
        const int number = createBaseFVarChannel(refiner, channel.value_count);
        const int* value = channel.values.data();
        for (int face = 0; face < getNumBaseFaces(refiner); ++face) {
            IndexArray values = getBaseFaceFVarValues(refiner, face, number);
            std::copy_n(value, values.size(), values.begin());
            value += values.size();
        }
    }
    return true;
}

}  // namespace Far
}  // namespace OPENSUBDIV_VERSION
}  // namespace OpenSubdiv

namespace trapeze {

SubdivisionTags read_tags(const SubdivisionMesh& mesh, SourceLocation location, Diagnostics& diagnostics) {
    return TagReader(mesh, location, diagnostics).read();
}

std::unique_ptr<TopologyRefiner> make_refiner(const SubdivisionMesh& mesh, const SubdivisionTags& tags,
                                              std::span<const FaceVaryingTopology> channels,
                                              SourceLocation location, Diagnostics& diagnostics) {
    // Checked here, for the library itself would only say that it failed, or run out of memory later.
    std::string reason = reason_to_refuse(mesh);
    if (reason.empty()) {
        const RefinerInput input{mesh, tags, channels};
        using Factory = TopologyRefinerFactory<RefinerInput>;
        std::unique_ptr<TopologyRefiner> refiner(
            Factory::Create(input, Factory::Options(scheme_type(mesh.scheme), tags.options)));
        if (refiner) {
            const auto& level = refiner->GetLevel(0);
            for (const auto& crease : tags.creases)
                if (level.FindEdge(crease.a, crease.b) == OpenSubdiv::Far::INDEX_INVALID)
                    diagnostics.warning(location,
                                        "SubdivisionMesh: tag \"crease\": no face has an edge from vertex " +
                                            std::to_string(crease.a) + " to " + std::to_string(crease.b) +
                                            "; ignored",
                                        "subdivision-crease-edge");
            return refiner;
        }
        reason = "OpenSubdiv does not take its topology";
    }
    diagnostics.error(location, "SubdivisionMesh: " + reason + "; mesh skipped", "subdivision-topology");
    return nullptr;
}

}  // namespace trapeze
