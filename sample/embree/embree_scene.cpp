#include "sample/embree/embree_scene.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <stdexcept>
#include <string>

namespace trapeze {
namespace {

/// Embree reads whole vectors of four floats, also at the last vertex.
constexpr size_t kFloatPadding = 4;

/// The header does not know Embree's enumeration, for the program is built without Embree's headers.
RTCBuildQuality quality_of(EmbreeQuality quality) {
    switch (quality) {
        case EmbreeQuality::Low:
            return RTC_BUILD_QUALITY_LOW;
        case EmbreeQuality::Medium:
            return RTC_BUILD_QUALITY_MEDIUM;
        case EmbreeQuality::High:
            return RTC_BUILD_QUALITY_HIGH;
    }
    return RTC_BUILD_QUALITY_MEDIUM;
}

/// Embree reports errors by device, and only when asked: this asks, and throws. A build that failed unnoticed
/// would be a scene in which nothing is hit.
void check(RTCDevice device) {
    switch (rtcGetDeviceError(device)) {
        case RTC_ERROR_NONE:
            return;
        case RTC_ERROR_OUT_OF_MEMORY:
            throw std::bad_alloc();
        default:
            throw std::runtime_error("Embree could not build its tree");
    }
}

/// Called by Embree from any of its threads, for each block that it takes or gives back. True: go on.
bool monitor_memory(void* bytes, ssize_t change, bool) {
    *static_cast<std::atomic<int64_t>*>(bytes) += change;
    return true;
}

/// A grid's vertices at a key, row by row from the last u to the first, x y z each. So the diagonal by which
/// Embree halves what it takes for a cell, from its 10 to its 01, is ours.
void copy_key(const Grid& grid, int key, float* out) {
    const int segment = std::min(key, segment_count(grid.key_count) - 1);
    const bool at_end = key > segment;  // the last key is the end of the last segment
    const GridShape& shape = grid.shape;
    const float* from[3] = {grid.plane(segment, 0), grid.plane(segment, 1), grid.plane(segment, 2)};
    const size_t to_delta = size_t{3} * shape.plane_size();
    for (int j = 0; j <= shape.nv; ++j)
        for (int i = shape.nu; i >= 0; --i, out += 3) {
            const int at = shape.tiled_index(i, j);
            for (int k = 0; k < 3; ++k)
                out[k] = at_end ? position_at(from[k][at], from[k][at + to_delta], 1) : from[k][at];
        }
}

/// Fills the vertex buffer: all grids of key 0, then all of key 1, and so on, as Embree wants time steps.
/// Embree reads 16 bytes at each vertex of 12, so that the buffer needs some floats behind its end.
void copy_positions(EmbreeMesh& mesh) {
    const size_t count = mesh.vertex_count * static_cast<size_t>(mesh.key_count) * 3;
    mesh.positions = std::make_unique_for_overwrite<float[]>(count + kFloatPadding);
    std::fill_n(mesh.positions.get() + count, kFloatPadding, 0.0f);
    tbb::parallel_for(size_t{0}, mesh.grids.size(), [&mesh](size_t i) {
        for (int key = 0; key < mesh.key_count; ++key) {
            const size_t first = mesh.vertex_count * static_cast<size_t>(key) + mesh.windows[i].startVertexID;
            copy_key(mesh.grid(i), key, mesh.positions.get() + 3 * first);
        }
    });
}

/// Corners and ids of all micropolygons, for the geometry "quad": 10, 00, 01, 11 of each, for in the buffer u
/// falls along a row.
void list_quads(EmbreeMesh& mesh) {
    std::vector<size_t> first(mesh.grids.size() + 1, 0);
    for (size_t i = 0; i < mesh.grids.size(); ++i)
        first[i + 1] = first[i] + static_cast<size_t>(mesh.grid(i).shape.micropolygon_count());
    mesh.quad_count = first.back();
    mesh.corners = std::make_unique_for_overwrite<uint32_t[]>(4 * mesh.quad_count);
    mesh.quads = std::make_unique_for_overwrite<uint64_t[]>(mesh.quad_count);
    tbb::parallel_for(size_t{0}, mesh.grids.size(), [&](size_t i) {
        const GridShape shape = mesh.grid(i).shape;
        const auto row = static_cast<uint32_t>(shape.vertices_u());
        size_t quad = first[i];
        for (uint32_t v = 0; v < shape.nv; ++v)
            for (uint32_t u = 0; u < shape.nu; ++u, ++quad) {
                const uint32_t corner = mesh.windows[i].startVertexID + v * row + (shape.nu - 1 - u);
                uint32_t* to = mesh.corners.get() + 4 * quad;
                to[0] = corner, to[1] = corner + 1, to[2] = corner + row + 1, to[3] = corner + row;
                mesh.quads[quad] =
                    MicropolygonId{mesh.grids[i], static_cast<uint8_t>(u), static_cast<uint8_t>(v)}.packed();
            }
    });
}

/// A grid as Embree describes one: first vertex, stride of a row, vertices along a row, rows.
RTCGrid window_of(const GridShape& shape, size_t first_vertex) {
    const auto width = static_cast<unsigned short>(shape.vertices_u());
    return {static_cast<unsigned>(first_vertex), width, width,
            static_cast<unsigned short>(shape.vertices_v())};
}

}  // namespace

/// Copying is timed apart from building, since other methods read grids as they are. Embree says what its
/// tree takes through its memory monitor only.
EmbreeScene::EmbreeScene(const Grids& grids, const EmbreeChoices& choices, RTCFilterFunctionN filter) {
    const auto start = std::chrono::steady_clock::now();
    device_ = rtcNewDevice(choices.device.c_str());
    if (!device_) throw std::runtime_error("Embree does not run on this machine");
    rtcSetDeviceMemoryMonitorFunction(device_, monitor_memory, &bytes_);
    gather_meshes(grids, choices.quads);
    stats_.setup_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    commit(choices, filter);
    stats_.tree_bytes = static_cast<uint64_t>(std::max<int64_t>(0, bytes_));
}

EmbreeScene::~EmbreeScene() {
    if (scene_) rtcReleaseScene(scene_);
    if (device_) rtcReleaseDevice(device_);
}

/// One mesh for each number of keys, filtered and not: unfiltered ones are spared the call for each hit.
/// Embree knows keys of motion, and whether to call the filter, by geometry.
void EmbreeScene::gather_meshes(const Grids& grids, bool quads) {
    std::map<std::pair<int, bool>, EmbreeMesh> kinds;
    for (size_t i = 0; i < grids.grids.size(); ++i) {
        const Grid& grid = grids.grids[i];
        const bool filtered = !grid.opaque || grid.facing != Facing::Both;
        EmbreeMesh& mesh = kinds[{grid.key_count, filtered}];
        mesh.key_count = grid.key_count, mesh.filtered = filtered, mesh.all_grids = &grids;
        mesh.grids.push_back(static_cast<uint32_t>(i));
        mesh.windows.push_back(window_of(grid.shape, mesh.vertex_count));
        mesh.vertex_count += static_cast<size_t>(grid.shape.vertex_count());
    }
    for (auto& [kind, mesh] : kinds) {
        if (mesh.vertex_count > UINT32_MAX) throw std::bad_alloc();  // Embree numbers them in 32 bits
        copy_positions(mesh);
        if (quads) list_quads(mesh);
        meshes_.push_back(std::move(mesh));
    }
}

/// Errors are looked for once, after the commit: Embree keeps the first one.
void EmbreeScene::commit(const EmbreeChoices& choices, RTCFilterFunctionN filter) {
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, quality_of(choices.quality));
    for (EmbreeMesh& mesh : meshes_) attach(mesh, choices, filter);
    rtcCommitScene(scene_);
    check(device_);
}

/// Buffers are shared and not copied by Embree; the meshes own them and outlive the scene. The geometry
/// belongs to Embree's scene from here on.
void EmbreeScene::attach(EmbreeMesh& mesh, const EmbreeChoices& choices, RTCFilterFunctionN filter) {
    const auto type = choices.quads ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_GRID;
    const RTCGeometry geometry = rtcNewGeometry(device_, type);
    rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(mesh.key_count));
    constexpr size_t kVertexBytes = 3 * sizeof(float);
    for (int key = 0; key < mesh.key_count; ++key)
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, static_cast<unsigned>(key),
                                   RTC_FORMAT_FLOAT3, mesh.positions.get(),
                                   kVertexBytes * mesh.vertex_count * static_cast<size_t>(key), kVertexBytes,
                                   mesh.vertex_count);
    if (choices.quads)
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, mesh.corners.get(),
                                   0, 4 * sizeof(uint32_t), mesh.quad_count);
    else
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, mesh.windows.data(), 0,
                                   sizeof(RTCGrid), mesh.windows.size());
    rtcSetGeometryBuildQuality(geometry, quality_of(choices.quality));
    if (mesh.filtered) {
        rtcSetGeometryUserData(geometry, &mesh);
        rtcSetGeometryIntersectFilterFunction(geometry, filter);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);  // numbered as they come, like the meshes
    rtcReleaseGeometry(geometry);
}

/// The micropolygon of a hit. On a grid, Embree's coordinates run over all of it, 0 to 1, and so tell the
/// cell; its u falls where ours grows.
uint64_t EmbreeScene::micropolygon(const EmbreeMesh& mesh, unsigned primitive, float u, float v) {
    if (mesh.quads) return mesh.quads[primitive];
    const auto cell = [](float at, int count) {
        return std::clamp(static_cast<int>(at * static_cast<float>(count)), 0, count - 1);
    };
    const GridShape& shape = mesh.grid(primitive).shape;
    return MicropolygonId{mesh.grids[primitive], static_cast<uint8_t>(shape.nu - 1 - cell(u, shape.nu)),
                          static_cast<uint8_t>(cell(v, shape.nv))}
        .packed();
}

}  // namespace trapeze
