/// RISpec's description of a subdivision mesh (scheme, faces, tags) as the topology of OpenSubdiv.
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <memory>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace trapeze {

/// What a mesh's tags say, checked: all indices are within the mesh.
struct SubdivisionTags {
    /// An edge by its ends; whether a face has it is found out later.
    struct Crease {
        int a = 0, b = 0;  ///< vertices
        float sharpness = 0;
    };
    /// A vertex that stays sharp, and how far.
    struct Corner {
        int vertex = 0;
        float sharpness = 0;
    };

    std::vector<int> holes;
    std::vector<Crease> creases;
    std::vector<Corner> corners;
    OpenSubdiv::Sdc::Options options;
    /// Variables of class facevarying are bilinear on each face. This is also the default without a tag.
    bool linear_face_varying = true;
};

/// Tags that are unknown or wrong are reported, and left out.
SubdivisionTags read_tags(const SubdivisionMesh& mesh, SourceLocation location, Diagnostics& diagnostics);

/// Values at the corners of faces, with equal ones at a vertex made one: what differs is a seam.
/// [0, value_count) for each corner, in the order of the mesh.
struct FaceVaryingTopology {
    std::vector<int> values;
    int value_count = 0;
};

/// Null, with a diagnostic, for a mesh beyond OpenSubdiv's limits.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> make_refiner(const SubdivisionMesh& mesh,
                                                               const SubdivisionTags& tags,
                                                               std::span<const FaceVaryingTopology> channels,
                                                               SourceLocation location,
                                                               Diagnostics& diagnostics);

}  // namespace trapeze
