/// The working memory of bundle tracing: about 120 KB a thread. What one stage lists the next one reads:
/// candidates (grids), met packets, active rays (of one grid), block rays (of one block).
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "accel/wide/bundle.h"

namespace trapeze {

/// Rays that may meet a grid, one after another without gaps: what the tests of its boxes and blocks read.
struct ActiveRays {
    static constexpr size_t kRoom = RayBundle::kRoom + 16;

    size_t count = 0;
    /// The ray in camera space; `local`: its time within the grid's motion segment.
    alignas(64) float ox[kRoom], oy[kRoom], ux[kRoom], uy[kRoom], local[kRoom];
    /// The ray in the grid's axes: 1 / direction, and origin / direction, along each axis.
    alignas(64) float inverse[3][kRoom], offset[3][kRoom];
    alignas(64) float limit[kRoom];  ///< no box entered beyond this depth matters; negative past the end
    alignas(64) uint32_t ray[kRoom];
};

/// Active rays that may meet one block, without gaps, as the predicate reads them.
struct BlockRays {
    alignas(64) float ox[ActiveRays::kRoom], oy[ActiveRays::kRoom], ux[ActiveRays::kRoom],
        uy[ActiveRays::kRoom], local[ActiveRays::kRoom];
    alignas(64) uint32_t active[ActiveRays::kRoom];  ///< index in ActiveRays
};

/// Intervals of what rays hold, one column a packet (or one for all): x and y at depth z are within
/// d * z + o * (1 - z / focal distance).
struct RayIntervals {
    static constexpr size_t kRoom = RayBundle::kRoom;  ///< packets of a single lane, at worst
    /// Rows in pairs: the lower bounds are even, so that row + 1 is the upper one.
    enum Row { kDxMin, kDxMax, kDyMin, kDyMax, kOxMin, kOxMax, kOyMin, kOyMax, kTimeMin, kTimeMax, kRows };

    alignas(64) float row[kRows][kRoom];
};

/// A ray that waits for its block's vertices to come from memory (see let_wait()).
struct WaitingRay {
    uint32_t ray, grid;
    float local;  ///< time in the segment
    float depth;  ///< a lower bound of where it meets the grid
    uint16_t segment;
    uint8_t u, v;  ///< the block
};

/// Packets that may meet a grid, and which of their lanes do, a bit a lane.
struct MetPackets {
    uint32_t packet[RayIntervals::kRoom + 16],
        lanes[RayIntervals::kRoom + 16];  ///< whole vectors are written
};

/// Between what slopes, along x and y, rays from the origin see the micropolygons of a block (v * 4 + u).
struct SlopeBounds {
    alignas(64) float low[2][16], high[2][16];
};

/// A grid that some groups of packets may meet, no nearer than a depth.
struct Candidate {
    float depth;
    uint32_t grid, groups;
};

/// Packs a candidate into bits that have the order of depths: depth, grid (24 bits), a bit a group (8). A
/// float's bits have the order of integers once negative ones are inverted and the sign bit of others is set.
inline uint64_t candidate_of(float depth, uint32_t grid, uint32_t groups) {
    const auto bits = std::bit_cast<uint32_t>(depth);
    const uint32_t ordered = bits & 0x80000000u ? ~bits : bits | 0x80000000u;
    return uint64_t{ordered} << 32 | grid << 8 | groups;
}
/// The inverse of that packing; depths come back bit for bit.
inline Candidate candidate_of(uint64_t bits) {
    const auto ordered = static_cast<uint32_t>(bits >> 32), rest = static_cast<uint32_t>(bits);
    return {std::bit_cast<float>(ordered & 0x80000000u ? ordered & 0x7fffffffu : ~ordered), rest >> 8,
            rest & 0xff};
}
static_assert(WideTree::kMaxGrids <= size_t{1} << 24, "a grid's number and a byte in 32 bits");

/// One thread's working memory for all stages. No value in it outlives a call of trace_bundle().
struct BundleScratch {
    RayIntervals intervals;
    alignas(64) float farthest[RayIntervals::kRoom];  ///< per packet, the depth to which some ray still looks
    /// Packets go through the nodes above grids in so many groups, at most.
    static constexpr size_t kGroups = 4;
    float groups[RayIntervals::kRows][kGroups];  ///< the intervals of each
    std::vector<uint64_t> candidates, ordered;   ///< candidate_of()
    /// A node still to be stepped through, and the groups that meet it.
    struct Link {
        uint32_t node, groups;  ///< a bit a group
    };
    std::vector<Link> stack;
    uint32_t touched[RayIntervals::kRoom];  ///< packets that have active rays
    size_t touched_count = 0;
    MetPackets met_packets;    ///< of the grid that is visited
    OrientedSegment oriented;  ///< of it, in its segment, once a packet has come near
    BoxPlanes boxes;
    SlopeBounds slopes[16];     ///< of the grid's blocks, for sharp packets
    uint32_t slopes_known = 0;  ///< which of them are made, a bit a block
    ActiveRays active;
    static constexpr size_t kMetStride = ActiveRays::kRoom;  ///< a byte a ray at worst
    alignas(64) uint8_t met[16 * kMetStride + 64];  ///< per box, a bit for each active ray that meets it
    BlockRays block;
    /// Rays wait until there are kMostWaiting; a segment of a grid then still adds up to four rays for each
    /// of its 16 blocks.
    static constexpr size_t kMostWaiting = 32, kWaitingRoom = kMostWaiting + 64;
    size_t waiting_count = 0;
    WaitingRay waiting[kWaitingRoom];
    uint32_t nearer[kWaitingRoom];  ///< packets of those that have come to see something nearer
};

/// The arguments of trace_bundle(), which dispatch hands on as one.
struct TraceInput {
    const WideTree& tree;
    DepthRange range;
    float inverse_focal;
    RayBundle& rays;
    BundleScratch& scratch;
    SampleStats& stats;
};

}  // namespace trapeze
