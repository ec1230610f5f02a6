/// The grids as Embree sees them: vertex buffers, geometries and its tree.
#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <memory>
#include <vector>

#include "core/grid.h"
#include "core/stats.h"
#include "sample/embree/embree_library.h"

namespace trapeze {

/// Grids that are one geometry: Embree wants equal numbers of time steps in it, and calls filters for all of
/// it or for none. Vertices are copied out of the grids' tiles, because Embree reads rows of a stride; the
/// copies live as long as the tree.
struct EmbreeMesh {
    int key_count = 1;
    bool filtered = false;         ///< has layers or one-sided grids
    std::vector<uint32_t> grids;   ///< indices in Grids
    std::vector<RTCGrid> windows;  ///< where each grid's vertices are, rows of falling u
    size_t vertex_count = 0;
    std::unique_ptr<float[]> positions;   ///< x y z of all vertices, key after key
    std::unique_ptr<uint32_t[]> corners;  ///< of quads: four vertices each
    /// Null for grids: their micropolygons follow from where in the grid a hit is.
    std::unique_ptr<uint64_t[]> quads;  ///< of quads: MicropolygonId::packed()
    size_t quad_count = 0;
    const Grids* all_grids = nullptr;

    const Grid& grid(size_t i) const { return all_grids->grids[grids[i]]; }
};

/// Built with the threads of the calling task arena. Keeps a reference to the grids.
class EmbreeScene {
  public:
    /// `filter` is that of the meshes that are `filtered`; it gets the EmbreeMesh.
    EmbreeScene(const Grids& grids, const EmbreeChoices& choices, RTCFilterFunctionN filter);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCScene scene() const { return scene_; }
    /// Packets of 16 rays in one register.
    bool has_wide_packets() const {
        return rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
    }
    const BuildStats& stats() const { return stats_; }

    /// MicropolygonId::packed() of a hit.
    uint64_t micropolygon(unsigned mesh, unsigned primitive, float u, float v) const {
        return micropolygon(meshes_[mesh], primitive, u, v);
    }
    static uint64_t micropolygon(const EmbreeMesh& mesh, unsigned primitive, float u, float v);

  private:
    /// Grids stay where they are and are referred to; positions are copied, as Embree wants them in one
    /// piece.
    void gather_meshes(const Grids& grids, bool quads);
    /// Builds Embree's structure; no mesh may be attached afterwards.
    void commit(const EmbreeChoices& choices, RTCFilterFunctionN filter);
    void attach(EmbreeMesh& mesh, const EmbreeChoices& choices, RTCFilterFunctionN filter);

    /// Embree's threads change it until the device is released.
    std::atomic<int64_t> bytes_{0};  ///< what Embree has allocated
    /// Complete before the first is attached: Embree and its filters keep pointers to them and to their
    /// buffers.
    std::vector<EmbreeMesh> meshes_;
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
    BuildStats stats_;
};

}  // namespace trapeze
