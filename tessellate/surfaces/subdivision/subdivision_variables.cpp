/// Primitive variables of subdivision meshes on grids.
#include <algorithm>

#include "tessellate/surfaces/subdivision/subdivision_surface.h"
#include "tessellate/surfaces/surface_variables.h"

namespace trapeze {
namespace {

bool is_face_varying(const Parameter& parameter) {
    return parameter.declaration.storage == StorageClass::FaceVarying ||
           parameter.declaration.storage == StorageClass::FaceVertex;
}

/// s and t of one mesh nearly always have their seams in the same places, and share a channel.
bool is_texture_coordinate(const Parameter& parameter) {
    return (parameter.name == "s" || parameter.name == "t") && parameter.declaration.floats_per_item() == 1;
}

/// The channel that a variable may join, or null.
FaceVaryingChannel* partner(std::vector<FaceVaryingChannel>& channels, const Parameter& parameter) {
    for (FaceVaryingChannel& channel : channels) {
        const Parameter& first = *channel.members.front().parameter;
        if (is_texture_coordinate(first) && is_texture_coordinate(parameter) &&
            first.declaration == parameter.declaration)
            return &channel;
    }
    return nullptr;
}

/// Gives corners at a vertex the same value where all members are equal there.
void weld(const SubdivisionMesh& mesh, FaceVaryingChannel& channel) {
    // A list of values for each vertex: the first, and for each value the next one at its vertex.
    std::vector<int> first_at(mesh.vertex_count, -1), next;
    std::vector<float> value(channel.size);
    channel.topology.values.resize(mesh.vertices.size());
    for (size_t corner = 0; corner < mesh.vertices.size(); ++corner) {
        for (const auto& member : channel.members) {
            const size_t floats = member.parameter->declaration.floats_per_item();
            std::copy_n(member.parameter->floats.data() + corner * floats, floats,
                        value.data() + member.first);
        }
        // Follows the vertex's list to an equal value, or to its end, where the new one is put.
        int* link = &first_at[mesh.vertices[corner]];
        while (*link >= 0 &&
               !std::equal(value.begin(), value.end(), channel.values.begin() + *link * channel.size))
            link = &next[*link];
        if (*link < 0) {
            *link = channel.topology.value_count++;
            channel.topology.values[corner] = *link;
            next.push_back(-1);
            channel.values.insert(channel.values.end(), value.begin(), value.end());
            continue;
        }
        channel.topology.values[corner] = *link;
    }
}

/// Values at points of one face. Variables whose components belong together are evaluated at once, when the
/// first of them is asked for.
class SubdivisionValues : public VariableSource {
  public:
    SubdivisionValues(const SubdivisionSurface& surface, int face, std::span<const V2f> uv,
                      SubdivisionScratch& scratch)
        : surface_(surface),
          piece_(surface.topology().piece(face)),
          uv_(uv),
          cached_(surface.cached_face(scratch, piece_.mesh_face)) {}

    void component(const Parameter& parameter, int component, std::span<float> values) const override;
    size_t uniform_index(const Parameter& parameter) const override;

  private:
    /// Evaluates a group of components into planes_, unless it is the group evaluated last.
    void evaluate(const void* group, const LimitPatch& patch, const float* values, int size) const;
    /// Values that are linear on the mesh's faces: varying, and facevarying where that is the rule.
    void linear(const Parameter& parameter, int component, std::span<float> values) const;

    const SubdivisionSurface& surface_;
    FacePiece piece_;
    std::span<const V2f> uv_;
    SubdivisionScratch::Face& cached_;
    mutable const void* evaluated_ = nullptr;
    mutable std::vector<float> planes_;  ///< of the group evaluated last
    mutable std::vector<float> points_;
};

/// All components of a group at once, since the patch's weights are most of the work; the components are then
/// handed out one by one.
void SubdivisionValues::evaluate(const void* group, const LimitPatch& patch, const float* values,
                                 int size) const {
    if (evaluated_ == group) return;
    evaluated_ = group;
    planes_.resize(uv_.size() * size);
    patch.gather(values, size, points_);
    patch.evaluate(points_, size, piece_, uv_, {planes_.data(), 1, uv_.size()}, {}, {});
}

void SubdivisionValues::linear(const Parameter& parameter, int component, std::span<float> values) const {
    const std::span<const int> vertices = surface_.topology().face_vertices(piece_.mesh_face);
    const size_t stride = parameter.declaration.floats_per_item();
    points_.resize(vertices.size());
    for (size_t i = 0; i < vertices.size(); ++i) {
        const size_t item = is_face_varying(parameter)
                                ? surface_.topology().first_corner(piece_.mesh_face) + i
                                : static_cast<size_t>(vertices[i]);
        points_[i] = parameter.floats[item * stride + component];
    }
    values_on_piece(piece_, points_.data(), uv_, values);
}

void SubdivisionValues::component(const Parameter& parameter, int component, std::span<float> values) const {
    int plane = component;
    // The patch of positions serves all variables of class vertex.
    if (parameter.declaration.storage == StorageClass::Vertex) {
        evaluate(&parameter, cached_.patch, parameter.floats.data(), parameter.declaration.floats_per_item());
    } else {
        const std::vector<FaceVaryingChannel>& channels = surface_.channels();
        const FaceVaryingChannel::Member* member = nullptr;
        size_t channel = 0;
        for (size_t c = 0; c < channels.size() && !member; ++c)
            for (const auto& m : channels[c].members)
                if (m.parameter == &parameter) member = &m, channel = c;
        // Varying, or facevarying without channels: linear.
        if (!member) return linear(parameter, component, values);
        evaluate(&channels[channel], surface_.cached_channel(cached_, static_cast<int>(channel)),
                 channels[channel].values.data(), channels[channel].size);
        plane += member->first;
    }
    std::copy_n(planes_.begin() + static_cast<ptrdiff_t>(plane * uv_.size()), values.size(), values.begin());
}

/// Variables without values in between (strings) are those of a face's first corner.
size_t SubdivisionValues::uniform_index(const Parameter& parameter) const {
    switch (parameter.declaration.storage) {
        case StorageClass::Constant:
            return 0;
        case StorageClass::Uniform:
            return piece_.mesh_face;
        case StorageClass::Varying:
        case StorageClass::Vertex:
            return surface_.topology().face_vertices(piece_.mesh_face)[0];
        case StorageClass::FaceVarying:
        case StorageClass::FaceVertex:
            return surface_.topology().first_corner(piece_.mesh_face);
    }
    return 0;
}

}  // namespace

/// Texture coordinates of one declaration share a channel, since OpenSubdiv's cost goes by channels; all
/// others have their own.
std::vector<FaceVaryingChannel> make_channels(const SubdivisionMesh& mesh, const ParameterList& variables,
                                              bool linear_face_varying) {
    std::vector<FaceVaryingChannel> channels;
    for (const Parameter& parameter : variables.values) {
        if (!is_face_varying(parameter) || parameter.is_string()) continue;
        if (parameter.declaration.storage == StorageClass::FaceVarying && linear_face_varying) continue;
        if (variables.find(parameter.name) != &parameter) continue;
        FaceVaryingChannel* channel = partner(channels, parameter);
        if (!channel) channel = &channels.emplace_back();
        channel->members.push_back({&parameter, channel->size});
        channel->size += parameter.declaration.floats_per_item();
    }
    for (FaceVaryingChannel& channel : channels) weld(mesh, channel);
    return channels;
}

/// u and v are the face's own: a subdivision mesh has no parameters of the whole (s and t follow them where
/// none are given).
bool SubdivisionSurface::evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch* scratch,
                                            ShadingGrid& grid) const {
    for (size_t i = 0; i < uv.size(); ++i) {
        grid.u[i] = grid.s[i] = uv[i].x;
        grid.v[i] = grid.t[i] = uv[i].y;
    }
    const SubdivisionValues values(*this, face, uv, static_cast<SubdivisionScratch&>(*scratch));
    return set_variables(primitive_.shape().variables, values, grid);
}

}  // namespace trapeze
